// Remarks about photographs without cameras, and about the cameras that were found for them.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind photograph_unreadable{"photograph_unreadable", Severity::loss,
                                                  "{name} was left out: {reason}."};
inline constexpr RemarkKind photographs_copied{
    "photographs_copied", Severity::note,
    "{count} {count:photograph is a copy|photographs are copies} of another one and "
    "{count:was|were} left out ({names})."};
inline constexpr RemarkKind photographs_unregistered{
    "photographs_unregistered", Severity::loss,
    "{count} of {all} photographs {count:has|have} no camera ({names})."};
inline constexpr RemarkKind smaller_models{
    "smaller_models", Severity::loss,
    "{count} {count:photograph|photographs} form smaller models, which are not used."};

// Reasons to stop, each with what to photograph again.

inline constexpr RemarkKind few_photographs{
    "few_photographs", Severity::loss,
    "{count} {count:photograph is|photographs are} too few: take 50 to 300, at least {least}, from "
    "all sides and with much overlap."};
inline constexpr RemarkKind few_features{
    "few_features", Severity::loss,
    "The photographs show too little detail: {features} {features:feature|features} each, and "
    "about "
    "1,000 are usual. Blank or shining surfaces, blur and darkness do this: take sharp photographs "
    "in good light that also show the surroundings."};
inline constexpr RemarkKind no_overlap{
    "no_overlap", Severity::loss,
    "The photographs share no details. Neighbouring photographs must show mostly the same things: "
    "take a photograph at every step, or at every ten degrees of the way around."};
inline constexpr RemarkKind no_motion{
    "no_motion", Severity::loss,
    "The photographs were taken from the same place: they show almost the same image. Take each "
    "from another place around the subject."};
inline constexpr RemarkKind only_turning{
    "only_turning", Severity::loss,
    "The camera only turned on the spot, which measures no distances. Walk around the subject, and "
    "take a step to the side between photographs."};
inline constexpr RemarkKind flat_pictures{
    "flat_pictures", Severity::loss,
    "The photographs show a plane, such as a picture or a wall, which does not determine the lens. "
    "Also show what stands in front of it or beside it, and from several sides."};
inline constexpr RemarkKind several_models{"several_models", Severity::loss,
                                           "The photographs fall into {count} parts without a "
                                           "connection ({parts}). Take photographs of the "
                                           "way between these places, or train each place alone."};
inline constexpr RemarkKind few_registered{
    "few_registered", Severity::loss,
    "Only {registered} of {all} photographs {registered:has|have} a camera. Take more photographs "
    "between those with a camera and the others ({names})."};
inline constexpr RemarkKind little_parallax{
    "little_parallax", Severity::loss,
    "The cameras stand too close together for their distance from the subject: the lines of sight "
    "to a point differ by {degrees:.1} degrees at the median. Take photographs from several "
    "sides."};
inline constexpr RemarkKind few_points{
    "few_points", Severity::loss,
    "The cameras rest on too few points: {points} for each photograph, where 25 to 460 are usual. "
    "Take sharper photographs with more overlap."};

}  // namespace tureen::remarks
