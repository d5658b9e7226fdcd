#include "tests/fuzz/fixtures.hpp"

#include <zlib.h>

#include <algorithm>
#include <filesystem>

#include "formats/dataset/camera_file.hpp"
#include "formats/mesh/off.hpp"
#include "formats/ply_file.hpp"
#include "formats/tureen_glb/compressed_geometry.hpp"
#include "formats/tureen_glb/compressed_texels.hpp"
#include "formats/tureen_glb/tureen_glb_compressed.hpp"
#include "jobs/bench/bench_json.hpp"
#include "jobs/bench/web_bench.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/glb_builder.hpp"
#include "tests/formats/splat/ksplat_fixture.hpp"
#include "tests/formats/splat/octagon_fixture.hpp"
#include "tests/formats/splat/sog_fixture.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/splat/spz_fixture.hpp"
#include "tests/formats/splat/usd_fixture.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/trainer/random_model.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/splats/splat_state.hpp"
#include "viewer/files/session.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace tureen::fuzz {

namespace {

using test::as_bytes;
using test::RandomScene;
using test::TensorFixture;
using test::TorchFixture;
using Content = std::vector<std::byte>;

Content content(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Content with_first_byte(std::size_t first, std::span<const std::byte> rest) {
  Content result(rest.size() + 1);
  result[0] = static_cast<std::byte>(first);
  std::copy(rest.begin(), rest.end(), result.begin() + 1);
  return result;
}

class Collection {
 public:
  void add(const char* target, const std::string& name, Content bytes) {
    list.push_back({target, name, std::move(bytes)});
  }
  void add(const char* target, const std::string& name, std::string_view text) {
    add(target, name, content(text));
  }
  /// Adds the file that `write` makes at a path.
  template <class Write>
  void add_file(const char* target, const std::string& name, Write&& write) {
    const auto path = scratch_.folder() / name;
    write(path);
    add(target, name, Input::open(path).read_rest());
  }

  std::vector<Fixture> list;

 private:
  Scratch scratch_{"fixtures"};
};

// ---- Scenes

Scene compressed_scene() {
  RandomScene random(3);
  Scene scene = random.scene();
  TriangleSoup soup = random.geometry(3, true);
  LatticeTexture texture = random.lattice_texture(3, 2, false);
  texture.mlp = random.diffsoup_mlp();
  soup.appearance = std::move(texture);
  only_soup(scene) = std::move(soup);
  return scene;
}

void add_glb(Collection& all) {
  // Each appearance once: with shared vertices, only the geometry differs.
  for (const test::GlbKind& kind : test::glb_kinds()) {
    const std::string name = kind.name;
    if (name.find("_shared") != std::string::npos && name != "uv_shared") continue;
    const Content bytes = test::glb_bytes(test::random_scene(kind, 1, 2), name);
    all.add("gltf", name + ".glb", bytes);
    if (name == "face_bytes" || name == "vertex_floats") all.add("preview", name + ".glb", bytes);
  }
  const Scene layers = test::layered_scene(
      test::glb_kinds_named({"face_bytes_shared", "lattice_bytes_mlp", "soft_triangles"}), 4, 2);
  all.add("gltf", "layers.glb", test::glb_bytes(layers, "layers"));
  for (const auto& kinds : {test::splat_glb_kinds(), test::surface_glb_kinds()})
    for (const test::GlbKind& kind : kinds)
      all.add("gltf", std::string(kind.name) + ".glb",
              test::glb_bytes(test::random_scene(kind, 1, 2), kind.name));
  const Scene scene = compressed_scene();
  const CompressedSoup compressed = encode_compressed(only_soup(scene), {});
  all.add_file("gltf", "compressed.glb",
               [&](const auto& path) { write_compressed_glb(scene, compressed, path); });

  const auto& soup = only_soup(scene);
  const std::size_t vertices = used_vertices(soup.triangles);
  all.add("compressed_geometry", "three_faces",
          with_first_byte(soup.triangles.size(), with_first_byte(vertices, compressed.geometry)));
  all.add("compressed_texels", "three_faces",
          with_first_byte(soup.triangles.size(), compressed.texels));
}

/// A triangle with a texture, a sparse accessor, a transform and a camera, all in one JSON.
std::string foreign_gltf() {
  return R"({"asset": {"version": "2.0", "generator": "by hand"}, "scene": 0,
 "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 0, 1], "scale": [1, 1, 2]},
           {"camera": 0}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2},
                             "indices": 3, "material": 0, "mode": 4}]}],
 "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 1, 1],
    "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
      {"offset": [0.5, 0], "rotation": 0.1, "scale": [2, 2]}}}},
    "alphaMode": "MASK", "alphaCutoff": 0.4, "extensions": {"KHR_materials_unlit": {}}}],
 "textures": [{"source": 0, "sampler": 0}],
 "samplers": [{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}],
 "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],
 "accessors": [
  {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 2,
    "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 1}}},
  {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"},
  {"bufferView": 3, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"},
  {"bufferView": 0, "byteOffset": 4, "componentType": 5123, "count": 3, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 12},
  {"buffer": 0, "byteOffset": 12, "byteLength": 24},
  {"buffer": 0, "byteOffset": 36, "byteLength": 24},
  {"buffer": 0, "byteOffset": 60, "byteLength": 12}],
 "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AQIAAAAAAQACAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA//wAA/wD/AP8AAP//"}]
})";
}

/// A mirror with normals as bytes, and glass that shares its positions, below a node that
/// stretches.
std::string foreign_surfaces() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "scale": [1, -2, 3]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0},
                            {"attributes": {"POSITION": 0, "NORMAL": 2}, "material": 1},
                            {"attributes": {"POSITION": 0}, "material": 2}]}],
 "materials": [{"name": "mirror", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1],
    "metallicFactor": 1, "roughnessFactor": 0.05}},
  {"name": "ball", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
   "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                  "KHR_materials_ior": {"ior": 1.33}}},
  {"pbrMetallicRoughness": {"metallicFactor": 0}}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
  {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36},
  {"buffer": 0, "byteOffset": 36, "byteLength": 12, "byteStride": 4}],
 "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,AACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/fwAAAAB/AAAAAH8A"}]
})";
}

/// A splat in an SPZ file.
Content spz_in_gltf() {
  test::GlbBuilder b;
  const std::string spz = test::spz_splat(3, 1).bytes();
  const int view = b.view(spz.data(), spz.size());
  nlohmann::json& primitive = b.primitive(nlohmann::json::object());
  primitive["mode"] = 0;
  primitive["extensions"]["KHR_gaussian_splatting"] = {
      {"kernel", "ellipse"},
      {"colorSpace", "srgb_rec709_display"},
      {"extensions", {{"KHR_gaussian_splatting_compression_spz_2", {{"bufferView", view}}}}}};
  return b.glb();
}

void add_text_meshes(Collection& all) {
  all.add("off", "faces.off",
          "OFF # a comment\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2 255 0 17\n"
          "3 0 2 3 0 255 18 128\n");
  all.add("off", "floats.off",
          "COFF\n3 1 3\n0 0 0 1 0 0.5 1\n1 0 0 0 1 0 1\n0 1 0 0 0 1 1\n3 0 1 2\n");
  all.add("off", "polygon.off",
          "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 1e-3\n4 0 1 2 3 0.1 0.2 0.3\n");
  all.add("ply", "ascii.ply",
          "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 4\r\nproperty float x\r\n"
          "property float y\r\nproperty float z\r\nproperty uchar red\r\nproperty uchar green\r\n"
          "property uchar blue\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
          "end_header\r\n0 0 0 255 0 0\r\n1 0 0 0 255 0\r\n1 1 nan 0 0 255\r\n0 1 0 9 9 9\r\n"
          "4 0 1 2 3\r\n");
  std::string big =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property float z\nproperty list uchar short extra\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n";
  const auto append = [&big](std::initializer_list<int> bytes) {
    for (const int byte : bytes) big += static_cast<char>(byte);
  };
  for (int v = 0; v < 3; ++v) {
    append({0x3f, 0xf0, 0, 0, 0, 0, 0, v, 0x3f, 0x80, 0, v, 0, 0, 0, 0});
    append({2, 0, 1, 0xff, 0xfe});
  }
  append({0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0xff, 0xff, 0xff, 0xff});
  all.add("ply", "strips.ply", big);
  RandomScene random(2);
  TriangleSoup soup = random.geometry(3, true);
  soup.appearance = FaceColors{random.colors(3, false)};
  Scene scene = scene_of(soup);
  all.add_file("ply", "faces.ply", [&](const auto& path) { write_ply(scene, path); });
  soup.appearance = VertexColors{random.colors(soup.positions.size(), true)};
  only_soup(scene) = soup;
  all.add_file("ply", "vertices.ply", [&](const auto& path) { write_ply(scene, path); });
  all.add("obj", "quad.obj",
          "# a quad\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 -1e2\nvt 0.25 0.75\nvt 1 0.75\n"
          "vn 0 0 1\ns off\nf 1/1 2/2 3/1/1 4/2/1\nf -1/-1 -2/-2 -3/-1\n");
  all.add("obj", "colors.obj",
          "mtllib a.mtl\ng a\nusemtl red\nv 0 0 0 1 0 0\nv 1 0 0 .5 1 0\nv 1 1 0\nv 0 1 0 1\n"
          "vt 0\nf 1 2 \\\n3//1 4/1\nl 1 2\nusemtl a b\nf -1 -2 -3\n");
  all.add("mtl", "red.mtl",
          "newmtl red\nKd 1 0 0\nd 0.4\nmap_Kd -s 1 2 -clamp on a b.png\nnewmtl a b\nKd .5\n"
          "Tr 0.1\nmap_d -o 1 a b.png\nKd xyz 1 1 1\n");
}

// ---- Splats

void add_splats(Collection& all) {
  const auto add = [&](const char* name, const Splats& splats) {
    all.add_file("splat_ply", name, [&](const auto& path) { write_ply(scene_of(splats), path); });
  };
  add("gaussians.ply", test::random_gaussians(1, 2, "3dgs", 1));
  add("discs.ply", test::random_gaussians(2, 2, "redisplats", 0, true));
  add("densities.ply", test::random_densities(3, 1, 3));
  all.add("splat_ply", "ascii.ply",
          test::PlyFixture("ascii")
              .element("vertex", test::splat_columns(0, 2),
                       {{1, 2, 3, 0, 0, 0, 0.1, 0.2, 0.3, -1, -2, -3, 1, 0, 0, 0}})
              .text());
  std::string records;
  for (int i = 0; i < 64; ++i) records += static_cast<char>(i % 32 < 24 ? 0x3e : 0x90 + i);
  all.add("splat_records", "two.splat", records);
  for (const int level : {0, 1, 2})
    all.add("ksplat", "level_" + std::to_string(level), test::two_ksplats(level));
  all.add("usd", "two_fields.usda", test::two_fields);
  test::ZipFixture usdz;
  usdz.entries = {{"scene.usda", test::two_fields}};
  all.add("usd", "two_fields.usdz", usdz.bytes());
  for (const int version : {1, 2})
    all.add("sog", "version_" + std::to_string(version) + ".sog",
            test::zipped(test::two_splats(version)));
  test::ZipFixture octagons = test::two_octagons().zip();
  all.add("octagon_npz", "stored.npz", octagons.bytes());
  for (auto& entry : octagons.entries) entry.deflate = true;
  all.add("octagon_npz", "deflated.npz", octagons.bytes());
  for (unsigned version = 1; version <= 4; ++version) {
    const std::string name = "version_" + std::to_string(version);
    test::SpzFixture spz = test::spz_splat(version, version);
    spz.extension(0xADBE0002, "camera limits");
    all.add("spz", name, with_first_byte(0, content(spz.bytes())));
    if (version < 4) all.add("spz", name + "_content", with_first_byte(1, content(spz.content())));
  }
}

// ---- Torch

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = 0.25f + 1e-4f * float(i);
  return values;
}

TorchFixture diffsoup_checkpoint() {
  TorchFixture torch;
  torch.add("feat_acc", TensorFixture::floats({1, 3, 7}, ramp(21)));
  torch.add("alpha_acc", TensorFixture::floats({1, 3, 1}, ramp(3)));
  torch.add("V", TensorFixture::floats({3, 3}, ramp(9)));
  torch.add("F", TensorFixture::ints({1, 3}, {0, 1, 2}));
  torch.add("color_mlp", {{"mlp.0.weight", TensorFixture::floats({16, 16}, ramp(256))},
                          {"mlp.0.bias", TensorFixture::floats({16}, ramp(16))},
                          {"mlp.2.weight", TensorFixture::floats({16, 16}, ramp(256))},
                          {"mlp.2.bias", TensorFixture::floats({16}, ramp(16))},
                          {"mlp.4.weight", TensorFixture::floats({3, 16}, ramp(48))},
                          {"mlp.4.bias", TensorFixture::floats({3}, ramp(3))}});
  torch.add("Rmax", 0);
  return torch;
}

TorchFixture triangle_splatting() {
  TorchFixture torch;
  TensorFixture points = TensorFixture::floats({2, 3, 3}, ramp(18));
  points.parameter = true;
  torch.add("triangles_points", points);
  torch.add("sigma", TensorFixture::floats({2, 1}, ramp(2)));
  torch.add("opacity", TensorFixture::floats({2, 1}, ramp(2)));
  torch.add("features_dc", TensorFixture::floats({2, 1, 3}, ramp(6)));
  torch.add("features_rest", TensorFixture::floats({2, 3, 3}, ramp(18)));
  torch.add("active_sh_degree", 1).add("spatial_lr_scale", 0.5);
  return torch;
}

TorchFixture connected_triangles() {
  TorchFixture torch;
  torch.add("triangles_points", TensorFixture::floats({3, 3}, ramp(9)));
  torch.add("_triangle_indices", TensorFixture::of<std::int64_t>("LongStorage", {1, 3}, {2, 0, 1}));
  torch.add("vertex_weight", TensorFixture::floats({3, 1}, ramp(3)));
  torch.add("features_dc", TensorFixture::floats({3, 1, 3}, ramp(9)));
  torch.add("active_sh_degree", 0).add("sigma", -9.25);
  return torch;
}

void add_torch(Collection& all) {
  all.add("checkpoint", "diffsoup.pt", diffsoup_checkpoint().bytes());
  TorchFixture deflated = triangle_splatting();
  deflated.deflate = true;
  all.add("checkpoint", "splatting_deflated.pt", deflated.bytes());
  TorchFixture large = connected_triangles();
  large.zip64 = true;
  all.add("checkpoint", "connected_zip64.pt", large.bytes());
  test::ZipFixture zip;
  zip.entries = {{"a/stored", "some bytes that are stored"},
                 {"a/deflated", std::string(300, 'x') + "y", true}};
  all.add("zip", "two.zip", zip.bytes());
  zip.zip64 = true;
  all.add("zip", "two_zip64.zip", zip.bytes());
  test::PickleFixture pickle;
  pickle.op("}(")
      .text("feat_acc")
      .integer(-3)
      .text("list")
      .op("]q\x01(K\x01M\x02\x03h\x01"
          "e");
  pickle.text("tuple").op("N\x88\x86").text("real").real(0.5).text("more").op("\x8a\x02\x01\xff");
  pickle.text("state").global("collections", "OrderedDict").op(")R}b").text("storage");
  pickle.op("(").text("storage").global("torch", "FloatStorage").text("0").text("cpu");
  pickle.integer(4).op("tQu");
  all.add("pickle", "all_opcodes.pkl", pickle.done());
}

// ---- Cameras and datasets

void add_cameras(Collection& all) {
  std::vector<Camera> cameras{look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 0.7, 64, 36),
                              look_at({3, 1, 1}, {0, 0, 0}, {0, 0, 1}, 0.5, 32, 20)};
  cameras[0].name = "one \"\xc3\xa4\"";
  all.add("cameras", "ours.json", cameras_to_json(cameras));
  const std::string frame =
      R"({"file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]})";
  const std::string transforms =
      R"({"fl_x": 9, "fl_y": 9.5, "cx": 4, "cy": 3, "w": 8, "h": 6, "k1": 0.01, "p1": -1e-3,
 "frames": [)" +
      frame + ", " + frame + "]}";
  all.add("cameras", "transforms.json", transforms);
  all.add("transforms", "transforms.json", transforms);
  all.add("transforms", "angle.json",
          R"({"camera_angle_x": 0.7, "frames": [)" + frame + "," + frame + "]}");
  const std::string masked =
      R"({"file_path": "./a.png", "mask_path": "mask.png", "k4": 0.001,
  "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]})";
  all.add(
      "transforms", "nerfstudio.json",
      R"({"camera_model": "OPENCV_FISHEYE", "fl_x": 9, "k1": -0.02, "ply_file_path": "points.ply",
 "applied_transform": [[1,0,0,0],[0,0,1,0],[0,-1,0,0]], "frames": [)" +
          masked + "," + masked + "]}");
  all.add("cameras", "gaussian.json",
          R"([{"id": 0, "img_name": "0001", "width": 64, "height": 36, "position": [1, 2, 3],
 "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fx": 50.0, "fy": 51}])");
  all.add(
      "camera_path", "loop.json",
      path_to_json({.keyframes = {{cameras[0], 0, 2.5}, {cameras[1], 1.5, 0}}, .loop_seconds = 4}));

  test::ColmapFixture model = test::upright_colmap(2);
  model.cameras.push_back({2, 4, "OPENCV", 8, 6, {10, 9, 4, 3, 0.1, 0.01, 1e-3, 1e-4}});
  all.add("colmap_binary", "cameras", with_first_byte(0, test::binary_cameras(model)));
  all.add("colmap_binary", "images", with_first_byte(1, test::binary_images(model)));
  all.add("colmap_binary", "points", with_first_byte(2, test::binary_points(model)));
  all.add("colmap_binary", "tracks", with_first_byte(3, test::binary_points(model)));
  all.add("colmap_text", "cameras", with_first_byte(0, content(test::text_cameras(model))));
  all.add("colmap_text", "images", with_first_byte(1, content(test::text_images(model))));
  all.add("colmap_text", "points", with_first_byte(2, content(test::text_points(model))));
  const std::string bundle =
      "# Bundle file v0.3\n2 1\n10.5 -0.02 0.001\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n0 0 0\n0 0 0\n"
      "0 0 0\n0 0 0\n0 0 0\n1 2 -3.5\n255 128 0\n1 0 7 1.5 -2.5\n";
  all.add("bundler", "bundle.out", with_first_byte(0, content(bundle)));
  all.add("bundler", "list.txt", with_first_byte(1, content("a.png 0 10.5\nb c.png\n")));
}

// ---- Images

/// A progressive JPEG of 8 x 8 grey pixels, by hand: stb cannot write it.
Content progressive_jpeg() {
  Content bytes;
  const auto append = [&](std::initializer_list<unsigned> values) {
    for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  };
  append({0xff, 0xd8, 0xff, 0xdb, 0, 67, 0});
  for (int i = 0; i < 64; ++i) append({16});
  append({0xff, 0xc2, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0});
  // Huffman tables: DC 0 is "0", DC 2 is "10"; the end of an AC block is "0".
  append({0xff, 0xc4, 0, 21, 0x00, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2});
  append({0xff, 0xc4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  append({0xff, 0xda, 0, 8, 1, 1, 0x00, 0, 0, 0, 0xbf});   // a DC of 3
  append({0xff, 0xda, 0, 8, 1, 1, 0x00, 1, 63, 0, 0x7f});  // no AC
  append({0xff, 0xd9});
  return bytes;
}

Content baseline_jpeg() {
  const Image8 image = test::an_image(20, 12, 3);
  std::string text;
  stbi_write_jpg_to_func(
      [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
      },
      &text, image.width, image.height, 4, image.pixels.data(), 80);
  return content(text);
}

void add_images(Collection& all) {
  all.add("image", "rgba.png", encode_png(test::an_image(9, 7)));
  std::string row;
  for (int i = 0; i < 8 * 5; ++i) row += static_cast<char>(37 * i);
  all.add(
      "image", "deep.png",
      PngFixture{.width = 5, .height = 1, .depth = 16, .rows = std::string(1, '\0') + row}.bytes());
  // Interlaced, 2 x 2, grey: three of the seven passes have pixels.
  all.add("image", "interlaced.png",
          PngFixture{.width = 2,
                     .height = 2,
                     .color_type = 0,
                     .interlace = 1,
                     .rows = std::string("\0\x10\0\x20\0\x30\x40", 7)}
              .bytes());
  Image8 small(5, 3);
  for (std::size_t i = 0; i < small.pixels.size(); ++i)
    small.pixels[i] = glm::u8vec4(i * 17, i * i, 255 - i, 200 + i);
  all.add("image", "lossless.webp", encode_webp(small, 6));
  all.add("image", "baseline.jpg", baseline_jpeg());
  all.add("image", "progressive.jpg", progressive_jpeg());
}

// ---- Runs and sessions

Content training_checkpoint_bytes(const Scratch& scratch) {
  trainer::Checkpoint checkpoint;
  checkpoint.config.steps = 700;
  checkpoint.views = {{"train/r_0", 3, 2, 17u, 18u}};
  trainer::TrainingState& state = checkpoint.state;
  state.model = trainer::test::random_model(4, {.faces = 2, .min_level = 0, .max_level = 1});
  state.moments.reset_faces(state.model);
  state.moments.steps = {5, 0};
  state.step = 70;
  state.baseline = {0, 1, 2, 3, 4, 5};
  state.errors = {0.5f, 0.25f};
  const auto path = scratch.folder() / "run.checkpoint";
  trainer::write_checkpoint(path, checkpoint);
  Content bytes = Input::open(path).read_rest();
  bytes.erase(bytes.end() - 4, bytes.end());  // the checksum; the target computes it
  return bytes;
}

template <class Checkpoint>
Content splat_checkpoint_bytes(const Scratch& scratch) {
  Checkpoint checkpoint;
  checkpoint.config.degree = 0;
  checkpoint.views = {{"train/r_0", 3, 2, 17u, 18u}};
  checkpoint.state.parameters = decltype(checkpoint.state.parameters)(2, 0);
  checkpoint.state.memory =
      trainer::SplatMemory(checkpoint.state.parameters.rows(), checkpoint.state.parameters.count());
  checkpoint.state.step = 70;
  checkpoint.state.epoch = {0};
  const auto path = scratch.folder() / "splats.checkpoint";
  trainer::write_checkpoint(path, checkpoint);
  Content bytes = Input::open(path).read_rest();
  bytes.erase(bytes.end() - 4, bytes.end());  // the checksum; the target computes it
  return bytes;
}

constexpr char training_config_text[] =
    R"({"preset": "scene", "steps": 5000, "background": [1, 1, 1], "baseline": false})";

constexpr char training_log_text[] =
    R"({"step":200,"seconds":14.2,"loss":0.081,"l1":0.052,"ssim":0.79,"train_psnr_db":21.3,"test_psnr_db":20.8,"triangles":15000,"it_per_second":14.1,"non_finite":0}
{"step":400,"seconds":28.4,"loss":null,"l1":0.051,"ssim":0.8,"train_psnr_db":21.4,"triangles":15000,"it_per_second":14.1,"non_finite":7}
)";

constexpr char session_text[] = R"({ "tureen_session": 1, "window": [640, 480], "events": [
  { "at": 0.0, "pointer": [10, 20.5] }, { "at": 0.1, "button": "left", "down": true },
  { "at": 0.2, "wheel": [0, -1] }, { "at": 0.3, "key": "A", "down": false },
  { "at": 0.4, "code_point": 228 }, { "at": 0.4, "drop": ["soup.glb"] },
  { "at": 0.5, "resize": [800, 600] }, { "at": 0.6, "focus": true }, { "at": 0.7, "await": true },
  { "at": 0.8, "picture": "end" }, { "at": 1, "close": true } ] })";

constexpr char settings_text[] =
    R"({ "window": [1280, 800], "vsync": true, "smooth_motion": false,
  "recent": ["/scenes/soup.glb", "/scenes/\u00e4.ply"], "pictures": "/images" })";

// ---- Benchmarks

void add_benchmarks(Collection& all) {
  const std::filesystem::path page = TUREEN_SOURCE_DIR "/tests/jobs/web_bench.json";
  Content bytes = Input::open(page).read_rest();
  Input input = Input::memory("web_bench.json", bytes);
  all.add("bench_result", "bench.json",
          results::to_json(results::read_web_bench(input).at(0)).dump());
  all.add("web_bench", "web_bench.json", std::move(bytes));
}

std::vector<Fixture> made_fixtures() {
  Collection all;
  add_glb(all);
  all.add("gltf", "foreign.gltf", foreign_gltf());
  all.add("gltf", "surfaces.gltf", foreign_surfaces());
  all.add("gltf", "spz.glb", spz_in_gltf());
  all.add("gltf", "meshopt.glb",
          Input::open(TUREEN_SOURCE_DIR "/tests/formats/data/gltfpack.glb").read_rest());
  add_text_meshes(all);
  add_splats(all);
  add_torch(all);
  add_cameras(all);
  add_images(all);
  add_benchmarks(all);
  const FolderFiles diffsoup = diffsoup_files(), mobilenerf = mobilenerf_files();
  const FolderFiles sog = sog_files();
  for (std::size_t i = 0; i < sog.size(); ++i) {
    std::string name = sog[i].first;  // "0_0/meta.json"
    std::replace(name.begin(), name.end(), '/', '_');
    all.add("sog_folder", name, with_first_byte(i, sog[i].second));
  }
  for (std::size_t i = 0, json = 0; i < sog.size(); ++i) {
    if (!sog[i].first.ends_with(".json")) continue;
    Content bytes{std::byte(json++), std::byte(1)};
    bytes.insert(bytes.end(), sog[i].second.begin(), sog[i].second.end());
    all.add("sog_needs", std::to_string(json) + ".json", std::move(bytes));
  }
  for (std::size_t i = 0; i < diffsoup.size(); ++i)
    all.add("diffsoup", diffsoup[i].first, with_first_byte(i, diffsoup[i].second));
  for (std::size_t i = 0; i < mobilenerf.size(); ++i)
    all.add("mobilenerf", mobilenerf[i].first, with_first_byte(i, mobilenerf[i].second));
  all.add("session", "events.json", session_text);
  all.add("settings", "viewer.json", settings_text);
  all.add("training_config", "config.json", training_config_text);
  all.add("training_log", "run.jsonl", training_log_text);
  const Scratch scratch("training");
  all.add("training_checkpoint", "run.checkpoint", training_checkpoint_bytes(scratch));
  all.add("training_checkpoint", "gaussians.checkpoint",
          splat_checkpoint_bytes<trainer::GaussianCheckpoint>(scratch));
  all.add("training_checkpoint", "neural.checkpoint",
          splat_checkpoint_bytes<trainer::NeuralCheckpoint>(scratch));
  return std::move(all.list);
}

}  // namespace

std::vector<std::byte> PngFixture::bytes() const {
  std::string result = "\x89PNG\r\n\x1a\n";
  const auto number = [](std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    std::string text;
    number(text, std::uint32_t(data.size()));
    text += type + data;
    const std::string checked = type + data;
    number(text, std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                     static_cast<uInt>(checked.size()))));
    result += text;
  };
  std::string header;
  number(header, width);
  number(header, height);
  for (const unsigned value : {unsigned(depth), unsigned(color_type), 0u, 0u, unsigned(interlace)})
    header += static_cast<char>(value);
  chunk("IHDR", header);
  std::string packed(compressBound(static_cast<uLong>(rows.size())), '\0');
  uLongf size = static_cast<uLongf>(packed.size());
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), static_cast<uLong>(rows.size()), 9);
  packed.resize(size);
  chunk("IDAT", packed);
  chunk("IEND", "");
  return content(result);
}

const std::vector<Fixture>& fixtures() {
  static const std::vector<Fixture> made = made_fixtures();
  return made;
}

}  // namespace tureen::fuzz
