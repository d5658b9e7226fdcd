// Remarks of the readers of datasets and cameras.
#pragma once

#include "base/decimal_text.hpp"
#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_of_transforms{
    "up_of_transforms", Severity::assumption, [](const Remark&) -> std::string {
      return "The up axis is assumed to be z, as in the scenes of NeRF and instant-ngp.";
    }};
inline constexpr RemarkKind up_of_cameras{
    "up_of_cameras", Severity::assumption, [](const Remark&) -> std::string {
      return "The up axis is assumed to be the mean of the cameras' up axes.";
    }};
inline constexpr RemarkKind up_of_no_camera{
    "up_of_no_camera", Severity::assumption, [](const Remark& r) {
      return "The cameras' up axes disagree; " + r.text("axis") + " is assumed.";
    }};
inline constexpr RemarkKind image_size_missing{
    "image_size_missing", Severity::assumption, [](const Remark& r) {
      return "the file has no image size; " + r.text("width") + " x " + r.text("height") +
             " is assumed";
    }};
inline constexpr RemarkKind lens_dropped{
    "lens_dropped", Severity::loss, [](const Remark&) -> std::string {
      return "the file's lens distortion is ignored: cameras are pinholes";
    }};
inline constexpr RemarkKind lens_undone{
    "lens_undone", Severity::note, [](const Remark& r) {
      return "Lens distortion was removed by resampling" +
             (r.count("columns") + r.count("rows") == 0
                  ? std::string()
                  : "; up to " + r.text("columns") + " columns and " + r.text("rows") +
                        " rows without source pixels were cropped") +
             ".";
    }};
inline constexpr RemarkKind fisheye_undone{
    "fisheye_undone", Severity::note, [](const Remark& r) {
      return "Fisheye photographs were resampled to pinhole images, at most " +
             fixed_decimal(r.number("degrees"), 0) + " degrees wide; their borders were cropped.";
    }};
inline constexpr RemarkKind points_missing{
    "points_missing", Severity::loss, [](const Remark& r) {
      return "The file with the dataset's points is missing: " + r.text("file");
    }};
inline constexpr RemarkKind pixels_masked{
    "pixels_masked", Severity::note, [](const Remark& r) {
      return "Masks exclude pixels of " + r.text("masked") + " of " +
             counted(r.count("all"), "photograph", "photographs") + ".";
    }};

}  // namespace tureen::remarks
