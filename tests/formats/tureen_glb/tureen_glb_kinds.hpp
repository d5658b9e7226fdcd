// Scenes of every kind that our GLB supports, the bytes of their files, and functions that change
// their JSON.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/formats/random_scene.hpp"

namespace tureen::test {

struct GlbKind {
  const char* name;
  std::function<void(RandomScene&, Scene&, std::size_t faces)> fill;
};

inline void fill_soup(Scene& scene, TriangleSoup soup, Appearance appearance) {
  soup.appearance = std::move(appearance);
  only_layer(scene).primitives = std::move(soup);
}

/// Each kind that has a mesh of triangles: the colour appearances, with shared and unshared
/// vertices, and triangle windows.
inline std::vector<GlbKind> glb_kinds() {
  std::vector<GlbKind> all;
  for (const bool shared : {false, true}) {
    const auto add = [&](const char* name, auto appearance) {
      all.push_back({name, [=](RandomScene& random, Scene& scene, std::size_t faces) {
                       TriangleSoup soup = random.geometry(faces, shared);
                       Appearance made = appearance(random, soup);
                       fill_soup(scene, std::move(soup), std::move(made));
                     }});
    };
    add(shared ? "face_bytes_shared" : "face_bytes", [](RandomScene& r, const TriangleSoup& s) {
      return FaceColors{r.colors(s.triangles.size(), true)};
    });
    add(shared ? "face_floats_shared" : "face_floats", [](RandomScene& r, const TriangleSoup& s) {
      return FaceColors{r.colors(s.triangles.size(), false)};
    });
    add(shared ? "vertex_bytes_shared" : "vertex_bytes", [](RandomScene& r, const TriangleSoup& s) {
      return VertexColors{r.colors(s.positions.size(), true)};
    });
    add(shared ? "vertex_floats_shared" : "vertex_floats",
        [](RandomScene& r, const TriangleSoup& s) {
          return VertexColors{r.colors(s.positions.size(), false)};
        });
    add(shared ? "face_harmonics_shared" : "face_harmonics",
        [](RandomScene& r, const TriangleSoup& s) {
          return r.harmonics(s.triangles.size(), Harmonics::Domain::face, 3);
        });
    add(shared ? "vertex_harmonics_shared" : "vertex_harmonics",
        [](RandomScene& r, const TriangleSoup& s) {
          return r.harmonics(s.positions.size(), Harmonics::Domain::vertex, 4);
        });
    add(shared ? "lattice_bytes_mlp_shared" : "lattice_bytes_mlp",
        [](RandomScene& r, const TriangleSoup& s) {
          LatticeTexture texture = r.lattice_texture(s.triangles.size(), 2, false);
          texture.mlp = r.diffsoup_mlp();
          return texture;
        });
    add(shared ? "lattice_bytes_mixed_levels_shared" : "lattice_bytes_mixed_levels",
        [](RandomScene& r, const TriangleSoup& s) {
          return r.lattice_texture(s.triangles.size(), {}, false);
        });
    add(shared ? "lattice_floats_shared" : "lattice_floats",
        [](RandomScene& r, const TriangleSoup& s) {
          LatticeTexture texture = r.lattice_texture(s.triangles.size(), {}, true);
          texture.mlp = r.mlp({7, 5, 3}, DirectionEncoding::none, {});
          return texture;
        });
    add(shared ? "uv_shared" : "uv",
        [](RandomScene& r, const TriangleSoup& s) { return r.uv_textures(s, false); });
    add(shared ? "uv_mlp_shared" : "uv_mlp",
        [](RandomScene& r, const TriangleSoup& s) { return r.uv_textures(s, true); });
  }
  for (const bool shared : {false, true})
    all.push_back({shared ? "normals_shared" : "normals",
                   [=](RandomScene& random, Scene& scene, std::size_t faces) {
                     TriangleSoup soup = random.geometry(faces, shared);
                     soup.normals = random.normals(soup.positions.size());
                     fill_soup(scene, std::move(soup), FaceColors{random.colors(faces, true)});
                   }});
  all.push_back({"soft_triangles", [](RandomScene& random, Scene& scene, std::size_t faces) {
                   only_layer(scene).primitives = random.windows(faces, 3);
                 }});
  return all;
}

/// Splats that need version 5, in every kernel, profile and degree. `faces` is their number.
inline std::vector<GlbKind> splat_glb_kinds() {
  std::vector<GlbKind> all;
  const auto add = [&](const char* name, auto splats) {
    all.push_back({name, [=](RandomScene& random, Scene& scene, std::size_t faces) {
                     only_layer(scene).primitives = splats(random, faces);
                   }});
  };
  add("gaussians_3dgs",
      [](RandomScene& r, std::size_t n) { return r.gaussians(n, 3, "3dgs", false); });
  add("gaussians_mip",
      [](RandomScene& r, std::size_t n) { return r.gaussians(n, 0, "mip", false); });
  add("flat_2dgs", [](RandomScene& r, std::size_t n) { return r.gaussians(n, 1, "2dgs", true); });
  add("flat_games", [](RandomScene& r, std::size_t n) { return r.gaussians(n, 4, "games", true); });
  add("flat_redisplats",
      [](RandomScene& r, std::size_t n) { return r.gaussians(n, 2, "redisplats", true); });
  add("neural_densities", [](RandomScene& r, std::size_t n) { return r.neural_densities(n, 2); });
  add("windows_of_another_profile", [](RandomScene& r, std::size_t n) {
    Splats splats = r.windows(n, 1);
    splats.profile.min_alpha = 0.1f;
    return splats;
  });
  add("windows_with_corner_colors",
      [](RandomScene& r, std::size_t n) { return r.windows_with_corner_colors(n, 3); });
  return all;
}

/// Mirrors and glass: their mesh has a material instead of COLOR_0, and normals that are shared
/// with the soup, copied for each corner, or left out because one is zero.
inline std::vector<GlbKind> surface_glb_kinds() {
  std::vector<GlbKind> all;
  const auto add = [&](const char* name, bool shared, bool zero, auto appearance) {
    all.push_back({name, [=](RandomScene& random, Scene& scene, std::size_t faces) {
                     TriangleSoup soup = random.geometry(faces, shared);
                     soup.normals = random.normals(soup.positions.size());
                     if (!zero && faces > 0) soup.normals[0] = {0, 0, -1};
                     fill_soup(scene, soup, appearance(random, soup));
                     only_layer(scene).material = random.material();
                   }});
  };
  const auto vertex_colors = [](RandomScene& r, const TriangleSoup& s) {
    return VertexColors{r.colors(s.positions.size(), true)};
  };
  add("surface", true, false, vertex_colors);
  add("surface_flat", true, true, vertex_colors);
  add("surface_of_corners", true, false, [](RandomScene& r, const TriangleSoup& s) {
    return FaceColors{r.colors(s.triangles.size(), true)};
  });
  return all;
}

inline std::vector<GlbKind> every_glb_kind() {
  std::vector<GlbKind> all = glb_kinds();
  for (GlbKind& kind : surface_glb_kinds()) all.push_back(std::move(kind));
  for (GlbKind& kind : splat_glb_kinds()) all.push_back(std::move(kind));
  return all;
}

inline Scene random_scene(const GlbKind& kind, unsigned seed, std::size_t faces) {
  RandomScene random(seed);
  Scene scene = random.scene();
  kind.fill(random, scene, faces);
  return scene;
}

/// A rotation, a scale and, if `mirrored`, a mirror.
inline glm::dmat4 random_similarity(RandomScene& random, bool mirrored) {
  const glm::dvec3 axis(random.real(-1, 1), random.real(-1, 1), random.real(0.1f, 1));
  const double scale = double(random.real(0.1f, 5));
  const glm::dvec3 scales(mirrored ? -scale : scale, scale, scale);
  const glm::dvec3 origin(1e6 * double(random.real(-1, 1)), 1.0 / 3.0, 1e-300);
  return at_origin(origin) *
         glm::scale(glm::rotate(glm::dmat4(1.0), 3.0 * double(random.real()), axis), scales);
}

/// A layer of each kind, all at different places. Every second one is hidden, every third mirrored.
inline Scene layered_scene(std::span<const GlbKind> kinds, unsigned seed, std::size_t faces) {
  RandomScene random(seed);
  Scene scene = random.scene();
  scene.layers.clear();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Scene one = random.scene();
    kinds[i].fill(random, one, faces);
    scene.layers.push_back({.name = kinds[i].name,
                            .world_from_layer = random_similarity(random, i % 3 == 1),
                            .visible = i % 2 == 0,
                            .primitives = std::move(one.layers.front().primitives),
                            .material = one.layers.front().material});
  }
  return scene;
}

/// The kinds with these names.
inline std::vector<GlbKind> glb_kinds_named(std::initializer_list<const char*> names) {
  std::vector<GlbKind> found;
  for (const GlbKind& kind : every_glb_kind())
    for (const std::string name : names)
      if (name == kind.name) found.push_back(kind);
  return found;
}

/// A path that only this process uses.
inline std::filesystem::path temporary_glb(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) /
         ("tureen_glb_" + name + std::to_string(getpid()) + ".glb");
}

inline std::vector<std::byte> glb_bytes(const Scene& scene, const std::string& name) {
  const auto path = temporary_glb(name);
  EXPECT_THAT(write_tureen_glb(scene, path), ::testing::IsEmpty());
  Input input = Input::open(path);
  std::vector<std::byte> bytes = input.read_rest();
  std::filesystem::remove(path);
  return bytes;
}

/// Why readers must not return this scene, or nullopt.
inline std::optional<std::string> scene_defect(const Scene& scene) {
  for (const Layer& layer : scene.layers) {
    if (auto reason = defect(layer)) return reason;
    if (auto reason = std::visit([](const auto& p) { return defect(p); }, layer.primitives))
      return reason;
  }
  return {};
}

inline nlohmann::json glb_json(std::span<const std::byte> bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const char* text = reinterpret_cast<const char*>(bytes.data()) + 20;
  return nlohmann::json::parse(text, text + size);
}

/// The same file with another JSON.
inline std::vector<std::byte> with_glb_json(std::span<const std::byte> bytes,
                                            const nlohmann::json& json) {
  std::uint32_t old_size = 0;
  std::memcpy(&old_size, bytes.data() + 12, 4);
  std::string text = json.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto size = std::uint32_t(text.size());
  const auto tail = bytes.subspan(20 + old_size);
  std::vector<std::byte> result(20 + size + tail.size());
  std::memcpy(result.data(), bytes.data(), 20);
  std::memcpy(result.data() + 20, text.data(), size);
  std::memcpy(result.data() + 20 + size, tail.data(), tail.size());
  const auto length = std::uint32_t(result.size());
  std::memcpy(result.data() + 8, &length, 4);
  std::memcpy(result.data() + 12, &size, 4);
  return result;
}

}  // namespace tureen::test
