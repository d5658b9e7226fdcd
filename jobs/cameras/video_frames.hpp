// Photographs from a video: the sharpest frame of each interval. Decoded by ffmpeg in two passes,
// the first one small, because no filter picks the best frame of an interval.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace tureen {

/// Whether the name ends in an extension of videos: .mp4, .mov, .mkv and so on.
bool is_video_file(const std::filesystem::path& path);

/// A frame of the first pass.
struct FrameFacts {
  /// Variance of the Laplacian: J. Pech-Pacheco and others, "Diatom autofocusing in brightfield
  /// microscopy", ICPR 2000.
  double sharpness = 0;
  /// Mean difference from the frame before, of 8-bit pixels of a thumbnail.
  double motion = 0;
};

/// Measures square grey frames of video_frame_side pixels, in order.
class FrameMeter {
 public:
  FrameFacts measure(std::span<const std::uint8_t> frame);

 private:
  std::vector<float> before_, thumbnail_;
};
inline constexpr int video_frame_side = 512;

/// The indices of the frames to keep, in order: 40 to 200, where there are as many. Intervals are
/// short where the picture changes fast: two a second, and one for each 24 grey levels of motion.
std::vector<std::size_t> chosen_frames(std::span<const FrameFacts> frames, double seconds);

/// Writes the chosen frames of the video as 00001.jpg and so on into `folder`, which exists.
/// `progress`: called with the fraction done; may throw. Throws InputError if ffmpeg finds no video
/// or cannot decode it; UsageError if ffmpeg is missing.
void take_video_frames(const std::filesystem::path& video, const std::filesystem::path& folder,
                       const std::function<void(double)>& progress);

}  // namespace tureen
