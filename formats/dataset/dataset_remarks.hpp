// Remarks of the readers of datasets and cameras.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_of_transforms{
    "up_of_transforms", Severity::assumption,
    "The up axis is assumed to be z, as in the scenes of NeRF and instant-ngp."};
inline constexpr RemarkKind up_of_cameras{
    "up_of_cameras", Severity::assumption,
    "The up axis is assumed to be the mean of the cameras' up axes."};
inline constexpr RemarkKind up_of_no_camera{"up_of_no_camera", Severity::assumption,
                                            "The cameras' up axes disagree; {axis} is assumed."};
inline constexpr RemarkKind image_size_missing{
    "image_size_missing", Severity::assumption,
    "the file has no image size; {width} x {height} is assumed"};
inline constexpr RemarkKind lens_dropped{
    "lens_dropped", Severity::loss,
    "the lens distortion of the file is ignored: views are drawn without it"};
inline constexpr RemarkKind lens_undone{"lens_undone", Severity::note,
                                        "Lens distortion was removed by resampling."};
inline constexpr RemarkKind lens_undone_cropped{
    "lens_undone", Severity::note,
    "Lens distortion was removed by resampling; up to {columns} columns and {rows} rows without "
    "source pixels were cropped."};
inline constexpr RemarkKind fisheye_undone{
    "fisheye_undone", Severity::note,
    "Fisheye photographs were resampled to pinhole images, at most {degrees:.0} degrees wide; "
    "their borders were cropped."};
inline constexpr RemarkKind points_missing{"points_missing", Severity::loss,
                                           "The file with the dataset's points is missing: {file}"};
inline constexpr RemarkKind points_unreadable{
    "points_unreadable", Severity::loss,
    "The file with the dataset's points cannot be read: {file}: {reason}"};
inline constexpr RemarkKind points_skipped{
    "points_skipped", Severity::loss,
    "{count} {count:point is|points are} damaged or not finite and {count:was|were} skipped."};
inline constexpr RemarkKind points_none{
    "points_none", Severity::note,
    "The dataset has no points; training begins at points in the photographs, or at random ones."};
inline constexpr RemarkKind photographs_skipped{
    "photographs_skipped", Severity::loss,
    "{count} of {all} photographs {count:was|were} skipped ({names}): {reason}."};
inline constexpr RemarkKind photographs_renamed{
    "photographs_renamed", Severity::assumption,
    "{count} {count:photograph was|photographs were} found by a similar name, such as {file} for "
    "{name}."};
inline constexpr RemarkKind photographs_resized{
    "photographs_resized", Severity::assumption,
    "The photographs have 1/{factor} of their cameras' size, rounded; the cameras were scaled."};
inline constexpr RemarkKind photographs_turned{
    "photographs_turned", Severity::assumption,
    "{count} {count:photograph was|photographs were} turned as {count:its|their} EXIF orientation "
    "says, because the cameras have that size."};
inline constexpr RemarkKind orientation_ignored{
    "orientation_ignored", Severity::assumption,
    "{count} {count:photograph has|photographs have} an EXIF orientation, which was ignored: the "
    "cameras have the stored size."};
inline constexpr RemarkKind smaller_images{
    "smaller_images", Severity::assumption,
    "The folder images is missing; the photographs are those of {folder}", "images"};
inline constexpr RemarkKind models_several{
    "models_several", Severity::assumption,
    "The dataset has several models; {chosen} with {count} photographs is used, not {others}."};
inline constexpr RemarkKind split_named{
    "split_named", Severity::note,
    "{source} names {train} training and {test} test views; {unused} photographs are in no list."};
inline constexpr RemarkKind split_names_unknown{
    "split_names_unknown", Severity::loss,
    "{source} names {count} {count:photograph|photographs} that the dataset does not have: "
    "{names}."};
inline constexpr RemarkKind split_empty{"split_empty", Severity::assumption,
                                        "The lists in {source} leave no training or no test views; "
                                        "every n-th photograph is a test view "
                                        "instead."};
inline constexpr RemarkKind split_without_test{
    "split_without_test", Severity::assumption,
    "The photographs of the {count} test {count:view|views} are missing; the dataset has no test "
    "views."};
inline constexpr RemarkKind alpha_is_background{
    "alpha_is_background", Severity::assumption,
    "The transparent pixels of {count} of {all} photographs are taken for background", "alpha"};
inline constexpr RemarkKind alpha_is_mask{
    "alpha_is_mask", Severity::assumption,
    "The transparent pixels of {count} of {all} photographs are taken for masks and excluded",
    "alpha"};
inline constexpr RemarkKind alpha_ignored{"alpha_ignored", Severity::note,
                                          "The alpha of {count} of {all} photographs was ignored."};
inline constexpr RemarkKind pixels_masked{
    "pixels_masked", Severity::note,
    "Masks exclude pixels of {masked} of {all} {all:photograph|photographs}."};

}  // namespace tureen::remarks
