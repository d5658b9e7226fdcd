// Datasets that tests write: images, and COLMAP models in both forms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "image/png.hpp"

namespace tureen::test {

inline void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  write_bytes(path, std::as_bytes(std::span(text)));
}

inline void write_image(const std::filesystem::path& path, const Image8& image) {
  write_bytes(path, encode_png(image));
}

/// A gradient; images with another `mark` differ.
inline Image8 an_image(int width, int height, int mark = 0, int alpha = 255) {
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = glm::u8vec4(7 * x, 5 * y, 16 * mark, alpha);
  return image;
}

/// A COLMAP model, with the records of its files.
struct ColmapFixture {
  struct CameraRecord {
    std::uint32_t number;
    std::int32_t model;
    std::string model_name;
    std::uint64_t width, height;
    std::vector<double> parameters;
  };
  struct ImageRecord {
    std::uint32_t number;
    double rotation[4], translation[3];
    std::uint32_t camera;
    std::string name;
    int features;
  };
  struct PointRecord {
    std::uint64_t number;
    double position[3];
    std::uint8_t color[3];
    int sightings;
  };
  std::vector<CameraRecord> cameras;
  std::vector<ImageRecord> images;
  std::vector<PointRecord> points;
};

/// One camera of 8 x 6 pixels, and `count` upright images a.png, b.png, ..
inline ColmapFixture upright_colmap(int count) {
  ColmapFixture model;
  model.cameras.push_back({1, 1, "PINHOLE", 8, 6, {10, 9, 4.5, 2.5}});
  for (int i = 0; i < count; ++i)
    model.images.push_back({std::uint32_t(i + 1),
                            {1, 0, 0, 0},
                            {0.25 * i, 0.5, 3},
                            1,
                            std::string(1, char('a' + i)) + ".png",
                            i % 3});
  model.points.push_back({7, {1, 2, 3}, {10, 20, 30}, 2});
  return model;
}

class LittleEndian {
 public:
  template <class T>
  LittleEndian& operator<<(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  LittleEndian& text(const std::string& value) {
    for (const char c : value) *this << c;
    return *this << '\0';
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

inline std::vector<std::byte> binary_cameras(const ColmapFixture& model) {
  LittleEndian out;
  out << std::uint64_t(model.cameras.size());
  for (const auto& camera : model.cameras) {
    out << camera.number << camera.model << camera.width << camera.height;
    for (const double parameter : camera.parameters) out << parameter;
  }
  return out.take();
}

inline std::vector<std::byte> binary_images(const ColmapFixture& model) {
  LittleEndian out;
  out << std::uint64_t(model.images.size());
  for (const auto& image : model.images) {
    out << image.number << image.rotation << image.translation << image.camera;
    out.text(image.name) << std::uint64_t(image.features);
    for (int i = 0; i < image.features; ++i) out << 1.5 << 2.5 << std::int64_t(-1);
  }
  return out.take();
}

inline std::vector<std::byte> binary_points(const ColmapFixture& model) {
  LittleEndian out;
  out << std::uint64_t(model.points.size());
  for (const auto& point : model.points) {
    out << point.number << point.position << point.color << 0.75 << std::uint64_t(point.sightings);
    for (int i = 0; i < point.sightings; ++i) out << std::uint32_t(1) << std::uint32_t(i);
  }
  return out.take();
}

inline std::ostringstream text_stream(const char* heading) {
  std::ostringstream out;
  out.precision(17);
  out << "# " << heading << "\n#   with a second line\n";
  return out;
}

inline std::string text_cameras(const ColmapFixture& model) {
  std::ostringstream out = text_stream("CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]");
  for (const auto& camera : model.cameras) {
    out << camera.number << ' ' << camera.model_name << ' ' << camera.width << ' ' << camera.height;
    for (const double parameter : camera.parameters) out << ' ' << parameter;
    out << '\n';
  }
  return out.str();
}

inline std::string text_images(const ColmapFixture& model) {
  std::ostringstream out = text_stream("IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME");
  for (const auto& image : model.images) {
    out << image.number;
    for (const double number : image.rotation) out << ' ' << number;
    for (const double number : image.translation) out << ' ' << number;
    out << ' ' << image.camera << ' ' << image.name << '\n';
    for (int i = 0; i < image.features; ++i) out << (i ? " " : "") << "1.5 2.5 -1";
    out << '\n';
  }
  return out.str();
}

inline std::string text_points(const ColmapFixture& model) {
  std::ostringstream out = text_stream("POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]");
  for (const auto& point : model.points) {
    out << point.number;
    for (const double number : point.position) out << ' ' << number;
    for (const std::uint8_t number : point.color) out << ' ' << int(number);
    out << " 0.75";
    for (int i = 0; i < point.sightings; ++i) out << " 1 " << i;
    out << '\n';
  }
  return out.str();
}

inline void write_binary(const std::filesystem::path& folder, const ColmapFixture& model) {
  write_bytes(folder / "cameras.bin", binary_cameras(model));
  write_bytes(folder / "images.bin", binary_images(model));
  write_bytes(folder / "points3D.bin", binary_points(model));
}

inline void write_text(const std::filesystem::path& folder, const ColmapFixture& model) {
  write_text(folder / "cameras.txt", text_cameras(model));
  write_text(folder / "images.txt", text_images(model));
  write_text(folder / "points3D.txt", text_points(model));
}

}  // namespace tureen::test
