#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>

#include "formats/common/format_remarks.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/ply_file.hpp"
#include "formats/scene_file.hpp"
#include "scene/edit/moved_normals.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace ply_test {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;

const std::string data_folder = std::string(TUREEN_SOURCE_DIR) + "/../shared/data/";

Scene read_bytes(const std::string& text) {
  Input input = input_of(text, "folder/plant.ply");
  return read_ply(input);
}

std::optional<Refusal> message_of(const std::string& text) {
  return error_of([&] { read_bytes(text); });
}

/// Builds a PLY value by value, in any encoding.
class Builder {
 public:
  explicit Builder(std::string encoding, std::string line_break = "\n")
      : encoding_(std::move(encoding)), break_(std::move(line_break)) {
    line("ply");
    line("format " + encoding_ + " 1.0");
  }
  Builder& line(const std::string& text) {
    text_ += text + break_;
    return *this;
  }
  template <class T>
  Builder& value(T v) {
    if (encoding_ == "ascii") {
      text_ += (text_.back() == '\n' ? "" : " ") + std::to_string(v);
    } else {
      char bytes[sizeof v];
      std::memcpy(bytes, &v, sizeof v);
      if (encoding_ == "binary_big_endian") std::reverse(bytes, bytes + sizeof v);
      text_.append(bytes, sizeof v);
    }
    return *this;
  }
  Builder& end_row() {
    if (encoding_ == "ascii") text_ += break_;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string encoding_, break_, text_;
};

/// Every scalar type, unusual orders, extra properties and lists, and an unknown element first.
std::string rich_file(const std::string& encoding, const std::string& line_break) {
  Builder b(encoding, line_break);
  for (const char* line :
       {"comment made by hand", "element weather 2", "property uint rain",
        "property list uchar double wind", "obj_info more", "element face 2", "property ushort red",
        "property short gap", "property list int8 uint16 vertex_index", "property ushort blue",
        "property ushort green", "property float64 area", "element vertex 4", "property double z",
        "property list uint int tags", "property int16 y", "property float x", "property int8 gap",
        "end_header"})
    b.line(line);
  b.value(std::uint32_t(4000000000u)).value(std::uint8_t(2)).value(1.5).value(-2.5).end_row();
  b.value(std::uint32_t(1)).value(std::uint8_t(0)).end_row();
  const auto face = [&](std::uint16_t red, const std::vector<std::uint16_t>& corners,
                        std::uint16_t blue, std::uint16_t green) {
    b.value(red).value(std::int16_t(-9)).value(std::int8_t(corners.size()));
    for (const std::uint16_t corner : corners) b.value(corner);
    b.value(blue).value(green).value(0.25).end_row();
  };
  face(65535, {0, 1, 2, 3}, 13107, 0);
  face(0, {3, 2, 0}, 0, 65535);
  for (int v = 0; v < 4; ++v) {
    b.value(v * 0.5).value(std::uint32_t(v));
    for (int k = 0; k < v; ++k) b.value(std::int32_t(-k));
    b.value(std::int16_t(-v)).value(float(v) + 0.25f).value(std::int8_t(7)).end_row();
  }
  return b.text();
}

TEST(Ply, ReadsAnyOrderTypeAndEncoding) {
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const std::string line_break : {"\n", "\r\n"}) {
      SCOPED_TRACE(encoding + (line_break.size() == 2 ? " CR LF" : " LF"));
      const Scene scene = read_bytes(rich_file(encoding, line_break));
      const TriangleSoup& soup = only_soup(scene);
      EXPECT_THAT(soup.positions, ElementsAre(glm::vec3(0.25f, 0, 0), glm::vec3(1.25f, -1, 0.5f),
                                              glm::vec3(2.25f, -2, 1), glm::vec3(3.25f, -3, 1.5f)));
      EXPECT_THAT(soup.triangles,
                  ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(3, 2, 0)));
      const glm::vec4 a(1.0f, 0.0f, 13107.0f / 65535.0f, 1.0f), c(0, 1, 0, 1);
      EXPECT_THAT(face_rgba(scene), ElementsAre(a, a, c));
      EXPECT_EQ(scene.info.name, "plant");
      EXPECT_EQ(scene.info.up, glm::vec3(0, 0, 1));
      EXPECT_THAT(scene.info.remarks,
                  Contains(Remark{&remarks::polygons_split, {{"polygons", 1}}}));
    }
}

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string vertices3 = "element vertex 3\n" + xyz;
const std::string faces1 = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string body3 = "0 0 0\n1 0 0\n0 1 0\n";

TEST(Ply, ReadsVertexColours) {
  const Scene bytes =
      read_bytes(ascii + vertices3 +
                 "property uchar diffuse_red\nproperty uchar green\nproperty uchar blue\nproperty "
                 "uchar alpha\n" +
                 faces1 +
                 "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                 "0 0 0 255 0 51 0\n1 0 0 1 2 3 4\n0 1 0 0 0 0 255\n3 0 1 2 9 9 9\n");
  EXPECT_THAT(vertex_rgba(bytes),
              ElementsAre(glm::vec4(1, 0, 51 / 255.0f, 0),
                          glm::vec4(1 / 255.0f, 2 / 255.0f, 3 / 255.0f, 4 / 255.0f),
                          glm::vec4(0, 0, 0, 1)));
  EXPECT_THAT(bytes.info.remarks, Contains(Remark{&remarks::face_colors_dropped}));
  const Scene floats = read_bytes(
      ascii + vertices3 + "property float red\nproperty double green\nproperty float blue\n" +
      faces1 + "end_header\n0 0 0 1 0.5 0\n1 0 0 2 nan 3\n0 1 0 0 0 0\n3 0 1 2\n");
  EXPECT_THAT(vertex_rgba(floats),
              ElementsAre(glm::vec4(1, 0.5f, 0, 1), glm::vec4(1, 0, 1, 1), glm::vec4(0, 0, 0, 1)));
  EXPECT_THAT(floats.info.remarks,
              Contains(Remark{&remarks::color_components_clamped, {{"components", 3}}}));
}

TEST(Ply, ReadsNormalsOfAnyLengthAndOnlyWholeOnes) {
  const auto normals = [](const std::string& properties, const std::string& values) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\n" +
        properties +
        "element face 1\nproperty list uchar int vertex_indices\n"
        "property float nx\nend_header\n";
    for (const char* vertex : {"0 0 0", "1 0 0", "0 1 0"})
      text += std::string(vertex) + " " + values + "\n";
    return only_soup(read_bytes(text + "3 0 1 2 9\n")).normals;
  };
  const std::string x = "property double nx\n", y = "property double ny\n",
                    z = "property double nz\n";
  EXPECT_THAT(normals(x + y + z, "0 3 4"), testing::Each(glm::vec3(0, 0.6f, 0.8f)));
  EXPECT_THAT(normals(x + z + y, "0 3 4"), testing::Each(glm::vec3(0, 0.8f, 0.6f)));
  EXPECT_THAT(normals(x + y + z, "nan 0 1"), testing::Each(glm::vec3(0)));
  EXPECT_TRUE(normals(x + y, "0 1").empty());
}

TEST(Ply, ReadsTriangleStrips) {
  const Scene scene =
      read_bytes(ascii + "element vertex 5\n" + xyz +
                 "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + body3 +
                 "1 1 0\n2 2 2\n9 0 1 2 3 -1 4 3 2 -1\n");
  EXPECT_THAT(only_soup(scene).triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(2, 1, 3), glm::uvec3(4, 3, 2)));
  EXPECT_EQ(face_rgba(scene).size(), 3u);
}

TEST(Ply, KeepsPositionsThatAreNotFinite) {
  const Scene scene =
      read_bytes(ascii + vertices3 + faces1 + "end_header\nnan 0 0\n-inf 0 0\n0 0 0\n3 0 1 2\n");
  EXPECT_TRUE(std::isnan(only_soup(scene).positions[0].x));
  EXPECT_EQ(only_soup(scene).positions[1].x, -INFINITY);
}

TEST(Ply, RemarksOnTrailingBytes) {
  const std::string text = ascii + vertices3 + faces1 + "end_header\n" + body3 + "3 0 1 2\n";
  EXPECT_THAT(read_bytes(text + "\n \nxyz").info.remarks,
              Contains(Remark{&remarks::bytes_ignored, {{"bytes", 3}}}));
  EXPECT_THAT(read_bytes(text + "\n \n").info.remarks,
              ElementsAre(Remark{&remarks::up_unknown_to_format, {{"format", "PLY"}}},
                          Remark{&remarks::colors_missing}));
  EXPECT_THAT(read_bytes(rich_file("binary_big_endian", "\n") + "xyz\n").info.remarks,
              Contains(Remark{&remarks::bytes_ignored, {{"bytes", 4}}}));
}

TEST(Ply, RefusesWhatIsNotTriangles) {
  EXPECT_THAT(message_of(ascii + vertices3 + "end_header\n" + body3),
              ErrorAt("plant.ply:3", "vertex", 3));
  EXPECT_THAT(message_of(ascii + faces1 + "end_header\n3 0 1 2\n"),
              ErrorAt("plant.ply:5", "vertex"));
}

TEST(Ply, RefusesByPlaceAndReason) {
  const std::string head = ascii + vertices3 + faces1 + "end_header\n";  // body from line 10
  EXPECT_THAT(message_of(head + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), ErrorAt("plant.ply:11"));
  EXPECT_THAT(message_of(head + "0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2\n"), ErrorAt("plant.ply:10", 7));
  EXPECT_THAT(message_of(head + body3 + "\n\n\n\n"), ErrorAt("plant.ply:17", "face"));
  EXPECT_THAT(message_of(head + body3 + "3 0 1 3\n"), ErrorAt("plant.ply:13", "face", 0, 3));
  EXPECT_THAT(message_of(head + body3 + "3 0 -1 1\n"), ErrorAt("plant.ply:13", "face", 0, -1, 3));
  EXPECT_THAT(message_of(head + body3 + "256 0 1 1\n"), ErrorAt("plant.ply:13", 256, 255));
  EXPECT_THAT(message_of(head + body3 + "200 0 1 1\n"),
              ErrorAt("plant.ply:13", "vertex_indices", 200, 7));
  EXPECT_THAT(message_of(ascii + "element vertex 0\nproperty ushort x\nproperty ushort z\n" +
                         faces1 + "end_header\n3 0 0 0\n"),
              ErrorAt("plant.ply:3", "vertex", "y"));
  EXPECT_THAT(message_of(ascii + "element vertex 1\n" + xyz + "property float x\n" + faces1 +
                         "end_header\n0 0 0 0\n3 0 0 0\n"),
              ErrorAt("plant.ply:3", "vertex", "x"));
  EXPECT_THAT(message_of(ascii + "element vertex 1\nproperty list int int x\n" + faces1 +
                         "end_header\n0 0 0 0\n3 0 0 0\n"),
              ErrorAt("plant.ply:3", "vertex", "x"));
  EXPECT_THAT(message_of(ascii + vertices3 + "property uchar red\n" + faces1 + "end_header\n" +
                         body3 + body3),
              ErrorAt("plant.ply:3", "vertex", "green"));
  EXPECT_THAT(message_of(ascii + vertices3 + "property int red\n" + faces1 + "end_header\n" +
                         body3 + body3),
              ErrorAt("plant.ply:3", "red"));
  EXPECT_THAT(message_of(ascii + vertices3 + "element face 1\nproperty int id\nend_header\n" +
                         body3 + "1\n"),
              ErrorAt("plant.ply:7", "face", "vertex_indices"));
  EXPECT_THAT(message_of(ascii + vertices3 +
                         "element face 1\nproperty list int float vertex_index\nend_header\n" +
                         body3 + "1\n"),
              ErrorAt("plant.ply:7", "face", "vertex_index"));

  Builder b("binary_little_endian");
  b.line("element vertex 1")
      .line("property char x")
      .line("property char y")
      .line("property char z");
  b.line("element face 2").line("property list char int vertex_indices").line("end_header");
  const std::string start = b.text();
  b.value(std::int8_t(0)).value(std::int8_t(0)).value(std::int8_t(0));
  const auto byte = [&](std::size_t n) { return "plant.ply@" + std::to_string(start.size() + n); };
  Builder negative = b;
  negative.value(std::int8_t(-2)).value(0).value(0).value(0);
  EXPECT_THAT(message_of(negative.text()), ErrorAt(byte(4), "vertex_indices", -2));
  Builder index = b;
  index.value(std::int8_t(3)).value(0).value(0).value(77).value(std::int8_t(0));
  EXPECT_THAT(message_of(index.text()), ErrorAt(byte(16), "face", 0, 77, 1));
  Builder shorter = b;
  shorter.value(std::int8_t(3)).value(0).value(0).value(0);
  EXPECT_THAT(message_of(shorter.text()), ErrorAt(byte(16), "face"));
}

// -- Row X1 of the catalogue of numerical hazards, clause by clause

const char* const encodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/// A square with these faces; `corner` replaces the second x.
std::string square(const std::string& encoding, const std::string& line_break,
                   const std::vector<std::vector<int>>& faces, float corner = 1.0f) {
  Builder b(encoding, line_break);
  b.line("element vertex 4").line("property float x").line("property float y");
  b.line("property float nx").line("property float z");  // the reader skips nx
  b.line("element face " + std::to_string(faces.size()));
  b.line("property uchar flags").line("property list uchar int vertex_indices");
  b.line("end_header");
  const float x[] = {0, corner, 1, 0}, y[] = {0, 0, 1, 1};
  for (int v = 0; v < 4; ++v) b.value(x[v]).value(y[v]).value(9.0f).value(0.5f).end_row();
  for (const std::vector<int>& face : faces) {
    b.value(std::uint8_t(7)).value(std::uint8_t(face.size()));
    for (const int index : face) b.value(index);
    b.end_row();
  }
  return b.text();
}

TEST(Ply, X1_BigEndianAsciiCarriageReturnsExtraPropertiesAndQuadsAreRead) {
  for (const std::string encoding : encodings)
    for (const std::string line_break : {"\n", "\r\n"}) {
      SCOPED_TRACE(encoding + (line_break.size() == 2 ? " CR LF" : " LF"));
      const Scene scene = read_bytes(square(encoding, line_break, {{0, 1, 2, 3}, {1, 2, 3}}));
      EXPECT_THAT(only_soup(scene).positions,
                  ElementsAre(glm::vec3(0, 0, 0.5f), glm::vec3(1, 0, 0.5f), glm::vec3(1, 1, 0.5f),
                              glm::vec3(0, 1, 0.5f)));
      // A quad becomes a fan at its position among the faces.
      EXPECT_THAT(only_soup(scene).triangles,
                  ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(1, 2, 3)));
    }
}

TEST(Ply, X1_FloatsThatAreNotFiniteAreKept) {
  for (const std::string encoding : encodings)
    for (const float value : {NAN, INFINITY, -INFINITY}) {
      const Scene scene = read_bytes(square(encoding, "\n", {{0, 1, 2}}, value));
      const float x = only_soup(scene).positions[1].x;
      EXPECT_TRUE(std::isnan(value) ? std::isnan(x) : x == value) << encoding << ' ' << value;
      EXPECT_EQ(only_soup(scene).positions[2], glm::vec3(1, 1, 0.5f));
      EXPECT_EQ(defect(only_soup(scene)), std::nullopt);
    }
}

// The catalogue suggests to skip such a face and keep the numbers of the others. SECURITY.md gives
// the reason for rejecting the file.
TEST(Ply, X1_FacesThatNameNoVertexRefuseTheFileByTheirNumber) {
  for (const std::string encoding : encodings)
    for (const int index :
         {-1, 4, 5, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()})
      for (std::size_t corner = 0; corner < 3; ++corner) {
        std::vector<std::vector<int>> faces{{0, 1, 2}, {1, 2, 3}, {0, 2, 3}};
        faces[1][corner] = index;
        EXPECT_THAT(message_of(square(encoding, "\n", faces)),
                    ErrorIn("plant.ply", "face", 1, index, 4))
            << encoding;
      }
}

TEST(Ply, X1_ZeroFacesAreNoSceneUnlessThereIsNothingAtAll) {
  for (const std::string encoding : encodings) {
    EXPECT_THAT(message_of(square(encoding, "\n", {})), ErrorAt("plant.ply:3", "vertex", 4));
    const Scene empty = read_bytes(Builder(encoding)
                                       .line("element vertex 0")
                                       .line("property float x")
                                       .line("property float y")
                                       .line("property float z")
                                       .line("element face 0")
                                       .line("property list uchar int vertex_indices")
                                       .line("end_header")
                                       .text());
    EXPECT_TRUE(only_soup(empty).positions.empty());
    EXPECT_TRUE(only_soup(empty).triangles.empty());
    EXPECT_EQ(defect(only_soup(empty)), std::nullopt);
    const TemporaryFolder folder;
    write_ply(empty, folder / "empty.ply");
    EXPECT_TRUE(only_soup(read_ply(folder / "empty.ply")).triangles.empty());
    // As in every format: an empty image would hide the error.
    EXPECT_THAT(error_of([&] { read_scene(folder / "empty.ply"); }), ErrorAt("empty.ply"));
  }
}

TEST(Ply, X1_SplatsThatLackAPropertyAreRefusedByIt) {
  const std::string head = ascii + "element vertex 1\n" + xyz + "property float f_dc_0\n";
  const std::string scales =
      "property float scale_0\nproperty float scale_1\nproperty float scale_2\n"
      "property float rot_0\nend_header\n0 0 0 0 0 0 0 0";
  EXPECT_THAT(message_of(head + scales + "\n"), ErrorAt("plant.ply:3", "vertex", "f_dc_1"));
  EXPECT_THAT(message_of(head + "property float f_rest_0\n" + scales + " 0\n"),
              ErrorAt("plant.ply:3", "vertex", 1));
}

TEST(Ply, X1_BodiesThatEndEarlyAreRefusedAtEveryLength) {
  for (const std::string encoding : encodings) {
    const std::string text = square(encoding, "\n", {{0, 1, 2, 3}, {1, 2, 3}});
    const std::size_t body = text.find("end_header\n") + 11;
    // A text without its last line break is complete.
    const std::size_t whole = encoding == "ascii" ? text.size() - 1 : text.size();
    for (std::size_t size = body; size < whole; ++size)
      EXPECT_THAT(message_of(text.substr(0, size)), ErrorIn("plant.ply"))
          << encoding << ' ' << size;
  }
}

TEST(Ply, X1_SizesOfFourGigabytesAreRefusedByTheirNumber) {
  for (const std::string encoding : encodings)
    for (const char* size : {"4294967295", "4294967296", "9223372036854775808"})
      for (const std::string element : {"vertex 4", "face 1"}) {
        std::string text = square(encoding, "\n", {{0, 1, 2}});
        const std::size_t at = text.find(element) + element.size() - 1;
        text.replace(at, 1, size);
        EXPECT_THAT(message_of(text), ErrorIn("plant.ply", size)) << encoding << ' ' << element;
      }
}

TEST(Ply, SurvivesTruncationAndDamage) {
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("damaged.ply", bytes);
    const Scene scene = read_ply(input);
    EXPECT_EQ(defect(only_soup(scene)), std::nullopt);
  };
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(encoding);
    const std::string text = rich_file(encoding, "\n");
    const auto bytes = std::as_bytes(std::span(text));
    const Survival cut = survive_truncation(bytes, read);
    // Every byte of a binary body is needed. A text does not need its last line break.
    EXPECT_EQ(cut.read, encoding == "ascii" ? 1u : 0u);
    EXPECT_GT(cut.refused, 0u);
    const Survival damaged = survive_damage(bytes, read);
    EXPECT_GT(damaged.read, 0u);
    EXPECT_GT(damaged.refused, 0u);
  }
}

TEST(Ply, ReadsAcrossBufferBordersAsASlowDecoderDoes_seed6) {
  // Rows of 7 bytes and lists of random length put buffer borders, every 64 KiB, at all positions.
  std::mt19937 random(6);
  Builder b("binary_big_endian");
  const int vertices = 30000, faces = 20000;
  b.line("element vertex 30000").line("property uchar gap").line("property short x");
  b.line("property short y").line("property short z").line("element face 20000");
  b.line("property list uchar uint vertex_indices").line("end_header");
  std::vector<glm::vec3> positions;
  for (int v = 0; v < vertices; ++v) {
    b.value(std::uint8_t(v));
    glm::vec3 p;
    for (int k = 0; k < 3; ++k) {
      const auto value = std::int16_t(random());
      b.value(value);
      p[k] = value;
    }
    positions.push_back(p);
  }
  std::vector<glm::uvec3> triangles;
  for (int f = 0; f < faces; ++f) {
    const int corners = 3 + int(random() % 4);
    b.value(std::uint8_t(corners));
    std::vector<std::uint32_t> indices;
    for (int k = 0; k < corners; ++k) {
      indices.push_back(random() % vertices);
      b.value(indices.back());
      if (k >= 2)
        triangles.emplace_back(indices[0], indices[std::size_t(k) - 1], indices[std::size_t(k)]);
    }
  }
  const Scene scene = read_bytes(b.text());
  EXPECT_EQ(only_soup(scene).positions, positions);
  EXPECT_EQ(only_soup(scene).triangles, triangles);
}

TEST(Ply, RoundTripsBitForBit_seed7) {
  std::mt19937 random(7);
  for (const bool by_vertex : {false, true})
    for (const bool bytes : {false, true}) {
      TriangleSoup soup;
      for (int i = 0; i < 200; ++i)
        soup.positions.emplace_back(std::ldexp(float(random()), -int(random() % 100)), -1.5f,
                                    1e-40f);
      for (int t = 0; t < 70; ++t) soup.triangles.emplace_back(random() % 200, random() % 200, t);
      std::vector<glm::vec4> rgba(by_vertex ? 200 : 70);
      for (glm::vec4& color : rgba)
        for (int c = 0; c < 4; ++c)
          color[c] = bytes ? float(random() % 256) / 255.0f : float(random()) / 4294967296.0f;
      if (by_vertex)
        soup.appearance = VertexColors{rgba};
      else
        soup.appearance = FaceColors{rgba};
      for (int i = 0; by_vertex && i < 200; ++i)
        soup.normals.push_back(unit_or_zero({double(random()), -1e9, double(random())}));
      Scene scene = scene_of(soup);
      scene.info.up = {0, 0, 1};
      const TemporaryFolder folder;
      EXPECT_THAT(write_ply(scene, folder / "a.ply"), ElementsAre());
      const Scene again = read_ply(folder / "a.ply");
      EXPECT_EQ(only_soup(again).positions, soup.positions);
      EXPECT_EQ(only_soup(again).triangles, soup.triangles);
      EXPECT_EQ(only_soup(again).normals, soup.normals);
      EXPECT_EQ(by_vertex ? vertex_rgba(again) : face_rgba(again), rgba);
      std::ifstream file(folder / "a.ply", std::ios::binary);
      const std::string text((std::istreambuf_iterator<char>(file)), {});
      EXPECT_EQ(text.find("property uchar red") != std::string::npos, bytes);
    }
}

TEST(Ply, HostileFilesEndWell) {
  const std::string folder = data_folder + "hostile/ply";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " does not exist";
  std::map<std::string, std::optional<Refusal>> errors;
  std::map<std::string, std::size_t> triangles;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().stem().string();
    std::size_t count = 0;
    errors[name] = error_of([&] {
      const Scene scene = read_ply(entry.path());
      EXPECT_EQ(defect(only_soup(scene)), std::nullopt) << name;
      count = only_soup(scene).triangles.size();
    });
    if (!errors[name]) triangles[name] = count;
  }
  EXPECT_GE(errors.size(), 36u);
  for (const char* name : {"extra-token-face-element", "extra-token-vertex-property",
                           "format-missing", "format-unsupported", "integer-literal-too-large",
                           "invalid-face-type", "positions-not-all", "positions-missing"})
    EXPECT_THAT(errors[name], ErrorIn(std::string(name) + ".ply")) << name;
  EXPECT_THAT(errors["integer-literal-too-large"],
              ErrorAt("integer-literal-too-large.ply:5", "vertex"));
  for (const auto& [name, count] : triangles) {
    const bool empty = name.rfind("empty", 0) == 0 || name.find("not-") != std::string::npos ||
                       name == "normals-unsupported-type";
    EXPECT_EQ(count > 0, !empty) << name;
  }
  EXPECT_EQ(triangles["crlf"], 3u);
  EXPECT_EQ(triangles["positions-colors4-normals-texcoords-float-indices-int-be-unaligned"], 3u);
}

}  // namespace ply_test
}  // namespace tureen
