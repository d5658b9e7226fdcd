// COLMAP's binary files: little-endian, packed, a count of 64 bits and then the records.
#include <algorithm>
#include <bit>

#include "formats/dataset/colmap.hpp"
#include "formats/dataset/colmap_records.hpp"

namespace tureen {

static_assert(std::endian::native == std::endian::little);

namespace {

/// A count of records of at least `bytes` bytes each, checked against the remaining bytes.
std::uint64_t read_count(Input& input, std::uint64_t bytes, const char* what) {
  const auto count = input.read_value<std::uint64_t>(what);
  if (count > input.remaining() / bytes)
    input.fail_at(input.position() - 8, "a count of " + std::to_string(count) + " " + what +
                                            ", which do not fit in the " +
                                            std::to_string(input.remaining()) + " bytes left");
  return count;
}

void expect_end(const Input& input, const char* what) {
  if (input.remaining() > 0)
    input.fail(std::to_string(input.remaining()) + " bytes after the last of the " + what);
}

void skip(Input& input, std::uint64_t bytes) { input.seek(input.position() + bytes); }

/// `begin`: of the camera. The number of parameters of an unknown model is unknown, too.
const ColmapLensModel& read_lens_model(Input& input, std::uint64_t begin) {
  const auto number = input.read_value<std::int32_t>("a camera model");
  const auto models = colmap_lens_models();
  if (number < 0 || std::size_t(number) >= models.size())
    input.fail_at(begin, unsupported_model("number " + std::to_string(number)));
  return models[std::size_t(number)];
}

std::string read_name(Input& input) {
  // Longer than any path that file systems support.
  constexpr std::size_t most = 4096;
  std::string name;
  while (const char c = input.read_value<char>("an image's name")) {
    name += c;
    if (name.size() > most) input.fail("an image's name of more than 4096 characters");
  }
  return name;
}

/// Its number, position, color, error and count of sightings.
constexpr std::uint64_t point_bytes = 8 + 3 * 8 + 3 + 8 + 8;

struct PointRecord {
  glm::dvec3 position;
  glm::u8vec3 color;
  double error;             // the mean of its projections
  std::uint64_t sightings;  // the images that show it, which follow: 8 bytes each
};

PointRecord read_point(Input& input) {
  PointRecord point;
  input.read_value<std::uint64_t>("a point");  // its number
  const auto position = input.read_value<std::array<double, 3>>("a point");
  point.position = {position[0], position[1], position[2]};
  const auto color = input.read_value<std::array<std::uint8_t, 3>>("a point");
  point.color = {color[0], color[1], color[2]};
  point.error = input.read_value<double>("a point");
  point.sightings = read_count(input, 8, "sightings");
  return point;
}

}  // namespace

ColmapCameras read_colmap_cameras_binary(Input& input) {
  ColmapCameras cameras;
  const std::uint64_t count = read_count(input, 4 + 4 + 8 + 8, "cameras");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t begin = input.position();
    const auto number = input.read_value<std::uint32_t>("a camera");
    ColmapCameraRecord record;
    record.model = &read_lens_model(input, begin);
    record.width = input.read_value<std::uint64_t>("a camera");
    record.height = input.read_value<std::uint64_t>("a camera");
    record.parameters = input.read_values<double>(record.model->parameters(), "a camera");
    input.take_memory(1, colmap_camera_bytes, "the cameras");
    if (!cameras.emplace(number, to_camera(record)).second)
      input.fail_at(begin, "camera " + std::to_string(number) + " occurs twice");
  }
  expect_end(input, "cameras");
  return cameras;
}

std::vector<ColmapImage> read_colmap_images_binary(Input& input) {
  std::vector<ColmapImage> images;
  const std::uint64_t count = read_count(input, 4 + 7 * 8 + 4 + 1 + 8, "images");
  for (std::uint64_t i = 0; i < count; ++i) {
    ColmapImage image;
    image.number = input.read_value<std::uint32_t>("an image");
    ColmapPoseRecord pose;
    pose.rotation = input.read_value<std::array<double, 4>>("an image");
    pose.translation = input.read_value<std::array<double, 3>>("an image");
    set_pose(image, pose);
    image.camera = input.read_value<std::uint32_t>("an image");
    image.name = read_name(input);
    // The features: x, y, and the point's number.
    skip(input, 24 * read_count(input, 24, "features"));
    input.take_memory(1, image.name.capacity(), "the images");
    input.make_room_in(images, 1, "the images");
    images.push_back(std::move(image));
  }
  expect_end(input, "images");
  return images;
}

ColmapPoints read_colmap_points_binary(Input& input) {
  ColmapPoints read;
  const std::uint64_t count = read_count(input, point_bytes, "points");
  input.make_room_in(read.points, count, "the points");
  for (std::uint64_t i = 0; i < count; ++i) {
    const PointRecord point = read_point(input);
    add_point(read, point.position, point.color);
    skip(input, 8 * point.sightings);
  }
  expect_end(input, "points");
  return read;
}

std::vector<ColmapTrack> read_colmap_tracks_binary(Input& input) {
  std::vector<ColmapTrack> tracks;
  const std::uint64_t count = read_count(input, point_bytes, "points");
  input.make_room_in(tracks, count, "the points");
  for (std::uint64_t i = 0; i < count; ++i) {
    const PointRecord point = read_point(input);
    ColmapTrack& track = tracks.emplace_back();
    track.position = point.position;
    track.error = point.error;
    input.make_room_in(track.images, point.sightings, "the points");
    for (std::uint64_t k = 0; k < point.sightings; ++k) {
      track.images.push_back(input.read_value<std::uint32_t>("a sighting"));
      input.read_value<std::uint32_t>("a sighting");  // the feature's number in the image
    }
  }
  expect_end(input, "points");
  return tracks;
}

}  // namespace tureen
