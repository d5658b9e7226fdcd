#include "jobs/cameras/video_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "base/decimal.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/platform/process.hpp"
#include "image/video_file.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

constexpr int thumbnail_side = 32, block = video_frame_side / thumbnail_side;

/// Without "file:", ffmpeg would read a colon as a protocol and a dash as an option.
std::string input_of(const fs::path& video) { return "file:" + video.string(); }

struct Facts {
  double seconds = 0, frames_per_second = 0;
};

/// By ffprobe; throws InputError if the file has no video.
Facts facts_of(const fs::path& video) {
  const std::string text =
      output_of("ffprobe", {"-v", "error", "-select_streams", "v:0", "-show_entries",
                            "stream=avg_frame_rate:format=duration", "-of",
                            "default=noprint_wrappers=1", input_of(video)});
  // A fraction, such as 30000/1001; 0 without the key, and below 0.
  const auto value = [&](const std::string& key) {
    const std::size_t at = text.find(key);
    if (at == std::string::npos) return 0.0;
    const std::string_view rest = std::string_view(text).substr(at + key.size());
    const Decimal above = parse_decimal(rest);
    if (!above.end || *above.end != '/') return double(above.value);
    const Decimal below = parse_decimal(above.end + 1);
    return below.value > 0 ? double(above.value) / double(below.value) : 0.0;
  };
  const Facts facts{.seconds = value("duration="), .frames_per_second = value("avg_frame_rate=")};
  if (text.find("avg_frame_rate=") == std::string::npos)
    throw InputError({video.string()}, "ffmpeg finds no video in this file");
  return facts;
}

/// Runs ffmpeg on the video, with `work` meanwhile. Throws InputError with its message if it fails.
void run_ffmpeg(const fs::path& video, std::vector<std::string> arguments, bool received,
                const std::function<void(Process&)>& work) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> complaints(std::tmpfile(), &std::fclose);
  if (!complaints) throw OutputError({}, "cannot create a temporary file for ffmpeg");
  const std::array first{"-nostdin"s, "-v"s, "error"s, "-i"s, input_of(video)};
  arguments.insert(arguments.begin(), first.begin(), first.end());
  std::optional<Process> process;
  try {
    process.emplace("ffmpeg", arguments,
                    Process::Options{.input = Process::Input::none,
                                     .output = nullptr,
                                     .errors = complaints.get(),
                                     .received = received,
                                     .own_group = true,
                                     .ends_with_us = true});
  } catch (const std::system_error& reason) {
    throw OutputError({}, "ffmpeg cannot be started: " + reason.code().message());
  }
  work(*process);
  if (process->wait() == 0) return;
  std::string text(200, '\0');
  std::rewind(complaints.get());
  text.resize(std::fread(text.data(), 1, text.size(), complaints.get()));
  throw InputError({video.string()},
                   "ffmpeg cannot decode the video: " + text.substr(0, text.find('\n')));
}

}  // namespace

bool is_video_file(const fs::path& path) {
  constexpr std::array names{".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".mts", ".3gp"};
  return std::find(names.begin(), names.end(), extension_of(path)) != names.end();
}

FrameFacts FrameMeter::measure(std::span<const std::uint8_t> frame) {
  constexpr int side = video_frame_side;
  FrameFacts facts;
  double sum = 0, squares = 0;
  for (int y = 1; y + 1 < side; ++y) {
    const std::uint8_t* row = &frame[std::size_t(y) * side];
    for (int x = 1; x + 1 < side; ++x) {
      const int value = row[x - 1] + row[x + 1] + row[x - side] + row[x + side] - 4 * row[x];
      sum += value;
      squares += value * value;
    }
  }
  const double count = double(side - 2) * (side - 2);
  facts.sharpness = squares / count - (sum / count) * (sum / count);
  thumbnail_.assign(thumbnail_side * thumbnail_side, 0.0f);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      thumbnail_[std::size_t(y / block * thumbnail_side + x / block)] +=
          float(frame[std::size_t(y) * side + x]) / (block * block);
  for (std::size_t i = 0; i < before_.size(); ++i)
    facts.motion += std::abs(thumbnail_[i] - before_[i]) / double(before_.size());
  std::swap(before_, thumbnail_);
  return facts;
}

std::vector<std::size_t> chosen_frames(std::span<const FrameFacts> frames, double seconds) {
  std::vector<std::size_t> chosen;
  if (frames.empty()) return chosen;
  constexpr double per_second = 2, levels = 24;
  std::vector<double> middles;  // of each frame on the path of all, in intervals
  double length = 0;
  for (const FrameFacts& frame : frames) {
    const double step = per_second * seconds / double(frames.size()) + frame.motion / levels;
    middles.push_back(length + 0.5 * step);
    length += step;
  }
  const double least = std::min<double>(40, double(frames.size()));
  const double intervals = std::clamp(std::round(length), least, 200.0);
  std::size_t current = std::size_t(-1);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto interval = std::size_t(
        std::min(intervals - 1, length > 0 ? intervals * middles[i] / length : double(i)));
    if (interval != current)
      chosen.push_back(i);
    else if (frames[i].sharpness > frames[chosen.back()].sharpness)
      chosen.back() = i;
    current = interval;
  }
  return chosen;
}

void take_video_frames(const fs::path& video, const fs::path& folder,
                       const std::function<void(double)>& progress) {
  require_there(video);
  if (!have_ffmpeg() || !is_on_path("ffprobe"))
    throw UsageError("videos need ffmpeg, which is not installed",
                     "install it, on Debian and Ubuntu with: apt-get install ffmpeg");
  const Facts facts = facts_of(video);
  const double expected = std::max(1.0, facts.seconds * facts.frames_per_second);
  std::vector<FrameFacts> frames;
  const std::string side = std::to_string(video_frame_side);
  run_ffmpeg(video,
             {"-an", "-fps_mode", "passthrough", "-vf", "scale=" + side + ":" + side, "-pix_fmt",
              "gray", "-f", "rawvideo", "-"},
             true, [&](Process& small) {
               std::vector<std::uint8_t> frame(std::size_t(video_frame_side) * video_frame_side);
               FrameMeter meter;
               while (small.receive(std::as_writable_bytes(std::span(frame))) == frame.size()) {
                 frames.push_back(meter.measure(frame));
                 progress(0.5 * std::min(1.0, double(frames.size()) / expected));
               }
             });
  if (frames.empty()) throw InputError({video.string()}, "the video has no frames");
  // ffmpeg refuses sums of more than about a hundred terms, but not sums of sums.
  std::string select;
  const std::vector<std::size_t> chosen = chosen_frames(frames, facts.seconds);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    select += fmt::format("{}eq(n,{})", i == 0 ? "(" : i % 20 == 0 ? ")+(" : "+", chosen[i]);
  select += ")";
  std::string output;  // in which % begins a number
  for (const char c : folder.string()) output += c == '%' ? "%%" : std::string(1, c);
  run_ffmpeg(video,
             {"-an", "-vf", "select='" + select + "'", "-fps_mode", "passthrough", "-q:v", "2",
              "-y", "file:" + output + "/%05d.jpg"},
             false, [&](Process& full) {
               while (!full.ended()) {
                 std::error_code error;
                 const auto written = std::distance(fs::directory_iterator(folder, error), {});
                 progress(0.5 + 0.5 * std::min(1.0, double(written) / double(chosen.size())));
                 std::this_thread::sleep_for(std::chrono::milliseconds(100));
               }
             });
}

}  // namespace tureen
