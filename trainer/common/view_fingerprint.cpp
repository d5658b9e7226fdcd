#include "trainer/common/view_fingerprint.hpp"

#include <fmt/format.h>

#include <array>

#include "trainer/common/checkpoint_file.hpp"

namespace tureen::trainer {

namespace {

/// Maximum side of an image, as in our own files.
constexpr std::int32_t max_side = 65'536;

}  // namespace

std::vector<ViewFingerprint> fingerprint(std::span<const Photograph> photographs) {
  std::vector<ViewFingerprint> views;
  for (const Photograph& photograph : photographs) {
    const Camera& camera = photograph.camera;
    const std::array intrinsics{camera.fx, camera.fy, camera.cx, camera.cy};
    const std::uint32_t sum = checksum(0, std::as_bytes(std::span(intrinsics)));
    const Image8 image = photograph.image();
    const std::vector<std::uint8_t> ignored = photograph.ignored();
    const std::uint32_t pixels = checksum(0, std::as_bytes(std::span(image.pixels)));
    views.push_back({.name = camera.name,
                     .width = camera.width,
                     .height = camera.height,
                     .camera = checksum(sum, std::as_bytes(std::span(&camera.view_from_world, 1))),
                     .pixels = checksum(pixels, std::as_bytes(std::span(ignored)))});
  }
  return views;
}

std::optional<std::string> difference(std::span<const ViewFingerprint> now,
                                      std::span<const ViewFingerprint> checkpoint) {
  if (now.size() != checkpoint.size())
    return fmt::format("the dataset has {} training views, but the checkpoint has {}", now.size(),
                       checkpoint.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const ViewFingerprint &here = now[i], &there = checkpoint[i];
    if (here.name != there.name)
      return fmt::format("training view {} is {}, but the checkpoint has {}", i, here.name,
                         there.name);
    if (here.width != there.width || here.height != there.height)
      return fmt::format("{} is {} x {}, but the checkpoint has {} x {}", here.name, here.width,
                         here.height, there.width, there.height);
    if (here.camera != there.camera) return here.name + ": the camera differs from the checkpoint";
    if (here.pixels != there.pixels) return here.name + ": the pixels differ from the checkpoint";
  }
  return std::nullopt;
}

std::optional<std::string> defect(std::span<const ViewFingerprint> views) {
  for (const ViewFingerprint& view : views)
    if (view.width < 1 || view.width > max_side || view.height < 1 || view.height > max_side)
      return fmt::format("a view has an invalid size of {} x {} pixels", view.width, view.height);
  return std::nullopt;
}

}  // namespace tureen::trainer
