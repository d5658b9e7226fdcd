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
    "lens_dropped", Severity::loss, "the file's lens distortion is ignored: cameras are pinholes"};
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
inline constexpr RemarkKind pixels_masked{
    "pixels_masked", Severity::note,
    "Masks exclude pixels of {masked} of {all} {all:photograph|photographs}."};

}  // namespace tureen::remarks
