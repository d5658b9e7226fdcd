// The previews of a training run as a video.
#pragma once

#include <filesystem>
#include <optional>

namespace tureen::trainer {

/// OUT-previews.mp4 for the folder OUT.previews.
std::filesystem::path preview_video_file(const std::filesystem::path& previews);

/// Writes the images step_N.png of the folder, in the order of their names, as a video of at most
/// ten seconds. Returns its path; nullopt without ffmpeg, or with fewer than two images of one
/// size. Throws InputError and OutputError.
std::optional<std::filesystem::path> write_preview_video(const std::filesystem::path& previews);

}  // namespace tureen::trainer
