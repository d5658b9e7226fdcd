#include "jobs/cameras/video_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/platform/process.hpp"
#include "image/video_file.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

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
  const auto value = [&](const std::string& key) -> const char* {
    const std::size_t at = text.find(key);
    return at == std::string::npos ? "" : text.c_str() + at + key.size();
  };
  char* end = nullptr;
  const double rate = std::strtod(value("avg_frame_rate="), &end);
  const double below = end && *end == '/' ? std::strtod(end + 1, nullptr) : 1;
  const Facts facts{.seconds = std::strtod(value("duration="), nullptr),
                    .frames_per_second = below > 0 ? rate / below : 0};
  if (text.find("avg_frame_rate=") == std::string::npos)
    throw InputError({video.string()}, "ffmpeg finds no video in this file");
  return facts;
}

class Ffmpeg {
 public:
  Ffmpeg(const fs::path& video, std::vector<std::string> arguments, bool received)
      : video_(video), complaints_(std::tmpfile(), &std::fclose) {
    if (!complaints_) throw OutputError({}, "cannot create a temporary file for ffmpeg");
    std::vector<std::string> all{"-nostdin", "-hide_banner", "-v", "error", "-i", input_of(video)};
    std::move(arguments.begin(), arguments.end(), std::back_inserter(all));
    try {
      process_ = std::make_unique<Process>("ffmpeg", all,
                                           Process::Options{.input = Process::Input::none,
                                                            .output = nullptr,
                                                            .errors = complaints_.get(),
                                                            .received = received,
                                                            .own_group = true});
    } catch (const std::system_error& reason) {
      throw OutputError({}, "ffmpeg cannot be started: " + reason.code().message());
    }
  }
  ~Ffmpeg() {
    if (process_) process_->kill();
  }
  Process& process() { return *process_; }

  /// Throws InputError with ffmpeg's message unless it succeeded.
  void finish() {
    const int code = process_->wait();
    if (code == 0) return;
    std::string text(500, '\0');
    std::rewind(complaints_.get());
    text.resize(std::fread(text.data(), 1, text.size(), complaints_.get()));
    text = text.substr(0, std::min<std::size_t>(200, text.find('\n')));
    throw InputError({video_.string()}, "ffmpeg cannot decode the video" +
                                            (text.empty() ? std::string() : ": " + text));
  }

 private:
  const fs::path& video_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> complaints_;
  std::unique_ptr<Process> process_;
};

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
  {
    const std::string side = std::to_string(video_frame_side);
    Ffmpeg small(video,
                 {"-an", "-fps_mode", "passthrough", "-vf", "scale=" + side + ":" + side,
                  "-pix_fmt", "gray", "-f", "rawvideo", "-"},
                 true);
    std::vector<std::uint8_t> frame(std::size_t(video_frame_side) * video_frame_side);
    FrameMeter meter;
    while (small.process().receive(std::as_writable_bytes(std::span(frame))) == frame.size()) {
      frames.push_back(meter.measure(frame));
      progress(0.5 * std::min(1.0, double(frames.size()) / expected));
    }
    small.finish();
  }
  if (frames.empty()) throw InputError({video.string()}, "the video has no frames");
  // ffmpeg refuses sums of more than about a hundred terms, but not sums of sums.
  std::string select;
  const std::vector<std::size_t> chosen = chosen_frames(frames, facts.seconds);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    select += fmt::format("{}eq(n,{})", i == 0 ? "(" : i % 20 == 0 ? ")+(" : "+", chosen[i]);
  select += ")";
  std::string output;  // in which % begins a number
  for (const char c : folder.string()) output += c == '%' ? "%%" : std::string(1, c);
  Ffmpeg full(video,
              {"-an", "-vf", "select='" + select + "'", "-fps_mode", "passthrough", "-q:v", "2",
               "-y", "file:" + output + "/%05d.jpg"},
              false);
  while (!full.process().ended()) {
    std::error_code error;
    std::size_t written = 0;
    for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
         at.increment(error))
      ++written;
    progress(0.5 + 0.5 * std::min(1.0, double(written) / double(chosen.size())));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  full.finish();
}

}  // namespace tureen
