#include "tests/support/trait_soups.hpp"

#include <algorithm>
#include <cassert>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::test {

namespace {

constexpr int channels = LatticeTexture::channels;

LatticeTexture& lattice_of(TriangleSoup& soup) { return std::get<LatticeTexture>(soup.appearance); }

std::vector<std::uint8_t>& bytes_of(TriangleSoup& soup) {
  return std::get<std::vector<std::uint8_t>>(lattice_of(soup).texels);
}

/// Calls change(face, x, y, values) for every texel of every face.
template <class Change>
void for_each_texel(TriangleSoup& soup, const Change& change) {
  const LatticeTexture& texture = lattice_of(soup);
  for (std::size_t t = 0; t < texture.patches.size(); ++t) {
    const LatticePatch& patch = texture.patches[t];
    for (std::uint32_t k = 0; k < lattice::texel_count(int(patch.level)); ++k) {
      const auto [x, y] = lattice::texel_coordinates(k);
      change(t, x, y, &bytes_of(soup)[(std::size_t(patch.first_texel) + k) * channels]);
    }
  }
}

/// Gives every face its own texels at the level of the first face. They are copies of its previous
/// texels if their number is equal.
void unshare_texels(TriangleSoup& soup) {
  LatticeTexture& texture = lattice_of(soup);
  const std::uint32_t level = texture.patches.front().level;
  const std::size_t each = std::size_t(lattice::texel_count(int(level))) * channels;
  std::vector<std::uint8_t> texels;
  for (LatticePatch& patch : texture.patches) {
    const auto first = bytes_of(soup).begin() + std::ptrdiff_t(patch.first_texel) * channels;
    const auto had = std::size_t(lattice::texel_count(int(patch.level))) * channels;
    patch = {std::uint32_t(texels.size() / channels), level};
    texels.insert(texels.end(), first, first + std::ptrdiff_t(std::min(had, each)));
    texels.resize(std::size_t(patch.first_texel) * channels + each, 255);
  }
  texture.texels = std::move(texels);
}

void make_opaque(TriangleSoup& soup) {
  for_each_texel(soup, [](std::size_t, int, int, std::uint8_t* texel) { texel[7] = 255; });
}

/// Splits every face into four faces of its colour, at the midpoints of its edges.
void split_faces(TriangleSoup& soup) {
  TriangleSoup split;
  FaceColors colors;
  const auto& rgba = std::get<FaceColors>(soup.appearance).rgba;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const glm::uvec3 v = soup.triangles[t];
    const glm::vec3 a = soup.positions[v.x], b = soup.positions[v.y], c = soup.positions[v.z];
    const glm::vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
    for (const glm::vec3& p : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
      split.positions.push_back(p);
    for (int i = 0; i < 4; ++i) {
      const auto first = std::uint32_t(3 * split.triangles.size());
      split.triangles.emplace_back(first, first + 1, first + 2);
      colors.rgba.push_back(rgba[t]);
    }
  }
  split.appearance = std::move(colors);
  soup = std::move(split);
}

/// A value below 100 for each face and channel, for faces that are constant or affine.
std::uint8_t face_value(std::size_t face, int channel) {
  return std::uint8_t((face * 37 + std::size_t(channel) * 59) % 100);
}

}  // namespace

std::vector<SpecialisationName> specialisations_of_soups() {
  std::vector<SpecialisationName> names(specialisation_names().begin(),
                                        specialisation_names().end());
  std::erase_if(names, [](const SpecialisationName& each) {
    return each.what == Specialisation::transparent_splats ||
           each.what == Specialisation::hidden_splats;
  });
  return names;
}

Kind kind_of_trait(Specialisation what) {
  switch (what) {
    case Specialisation::coincident_faces:
    case Specialisation::small_triangles:
      return Kind::face_colors;
    case Specialisation::shading_pass:
    case Specialisation::interpolation:
      return Kind::vertex_colors;
    case Specialisation::harmonics_bands:
      return Kind::face_harmonics;
    case Specialisation::constant_lattices:
    case Specialisation::affine_texels:
      return Kind::lattice;
    default:
      return Kind::lattice_mlp;
  }
}

void give_trait(Specialisation what, TriangleSoup& soup) {
  switch (what) {
    case Specialisation::alpha_test:
      return make_opaque(soup);
    case Specialisation::transparent_faces:
      return for_each_texel(soup, [](std::size_t face, int, int, std::uint8_t* texel) {
        if (face % 2 == 1) texel[7] = std::min<std::uint8_t>(texel[7], 127);
      });
    case Specialisation::coincident_faces: {
      auto& rgba = std::get<FaceColors>(soup.appearance).rgba;
      const std::size_t faces = soup.triangles.size();
      for (glm::vec4& color : rgba) color.a = 1.0f;
      for (std::size_t t = 0; t < faces; ++t) {
        soup.triangles.push_back(glm::uvec3(soup.triangles[t]));
        rgba.emplace_back(glm::vec3(rgba[faces - 1 - t]), 1.0f);
      }
      return;
    }
    case Specialisation::small_triangles:
      for (int i = 0; i < 2 || soup.triangles.size() < 65536; ++i) split_faces(soup);
      return;
    case Specialisation::interpolation: {
      auto& rgba = std::get<VertexColors>(soup.appearance).rgba;
      for (const glm::uvec3& t : soup.triangles) {
        rgba[t.x].a = 1.0f;
        rgba[t.y] = rgba[t.z] = rgba[t.x];
      }
      return;
    }
    case Specialisation::harmonics_bands: {
      auto& sh = std::get<Harmonics>(soup.appearance);
      const auto count = std::size_t(harmonics::count(sh.degree));
      // Together, bands 2, 3 and 4 move a channel by at most (5 + 7 + 9) / sqrt(4 pi) * 1e-4 <
      // 1/510.
      for (std::size_t i = 0; i < sh.coefficients.size(); ++i)
        if (i % count >= 4) sh.coefficients[i] = glm::vec3(i % 2 == 0 ? 1e-4f : -1e-4f);
      return;
    }
    case Specialisation::color_mlp:
      return for_each_texel(soup, [](std::size_t, int, int, std::uint8_t* texel) { texel[3] = 0; });
    case Specialisation::view_direction: {
      DenseLayer& first = lattice_of(soup).mlp->layers.front();
      for (std::size_t i = 0; i < first.weights.size(); ++i)
        if (i % 16 > 7) first.weights[i] *= 1e-6f;
      return;
    }
    case Specialisation::latent_features:
      return for_each_texel(soup, [](std::size_t, int, int, std::uint8_t* texel) {
        std::fill(texel + 4, texel + 7, std::uint8_t(100));
      });
    case Specialisation::dead_neurons: {
      ColorMlp& mlp = *lattice_of(soup).mlp;
      for (std::size_t l = 0; l + 1 < mlp.layers.size(); ++l)
        for (std::size_t o = 0; o < mlp.layers[l].biases.size(); o += 2)
          mlp.layers[l].biases[o] = -100.0f;
      return;
    }
    case Specialisation::constant_lattices:
      unshare_texels(soup);
      make_opaque(soup);
      return for_each_texel(soup, [](std::size_t face, int, int, std::uint8_t* texel) {
        for (int c = 0; c < LatticeTexture::features; ++c) texel[c] = face_value(face, c);
      });
    case Specialisation::affine_texels: {
      unshare_texels(soup);
      make_opaque(soup);
      // Steps of whole bytes are affine without rounding. 2^level (1 + 2) of them stay below 155.
      const int level = int(lattice_of(soup).patches.front().level);
      const int step = std::max(1, 50 >> level);
      return for_each_texel(soup, [step](std::size_t face, int x, int y, std::uint8_t* texel) {
        for (int c = 0; c < LatticeTexture::features; ++c)
          texel[c] = std::uint8_t((face_value(face, c) + step * x * (1 + c % 2) + step * y) % 256);
      });
    }
    case Specialisation::shading_pass:
    case Specialisation::background:
    case Specialisation::weight_uniforms:
      return;  // every soup of this kind has the trait
    case Specialisation::transparent_splats:
    case Specialisation::hidden_splats:
      break;
  }
  assert(!"a trait without a soup");
}

TriangleSoup soup_without_trait(Specialisation what, std::uint64_t seed) {
  SoupOptions options{.kind = kind_of_trait(what), .faces = 300, .level = 3};
  switch (what) {
    case Specialisation::shading_pass:
      options.kind = Kind::face_harmonics;
      break;
    case Specialisation::background:
      options.kind = Kind::face_colors;  // shaded forward
      break;
    case Specialisation::weight_uniforms:
      options.kind = Kind::lattice;
      break;
    default:
      break;
  }
  TriangleSoup soup = random_soup(seed, options);
  if (what == Specialisation::alpha_test || what == Specialisation::transparent_faces)
    // A hole in one corner of each face; all other texels are opaque.
    for_each_texel(soup, [](std::size_t, int x, int y, std::uint8_t* texel) {
      texel[7] = x == 0 && y == 0 ? 0 : 255;
    });
  if (what == Specialisation::affine_texels || what == Specialisation::constant_lattices)
    for_each_texel(soup, [](std::size_t, int x, int y, std::uint8_t* texel) {
      texel[0] = (x + y) % 2 == 0 ? 40 : 200;
    });
  return soup;
}

}  // namespace tureen::test
