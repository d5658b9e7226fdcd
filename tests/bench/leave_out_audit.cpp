// How much of real scenes the entries of docs/leaving-out.md would touch that plans do not leave
// out: docs/leaving-out.md gives these counts as the reason.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "formats/scene_file.hpp"
#include "soup/lattice.hpp"
#include "soup/lattice_levels.hpp"
#include "support/random.hpp"

namespace tureen::test {
namespace {

constexpr double half_step = 0.5 / 255.0;

/// Texels where the network has no say.
std::size_t unblended_texels(const LatticeTexture& texture, int blend_channel) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < texture.texel_count(); ++i)
    count += texture.value(i, blend_channel) <= half_step ? 1 : 0;
  return count;
}

std::size_t distinct_lattices(const LatticeTexture& texture) {
  std::set<std::vector<float>> known;
  for (const LatticePatch& patch : texture.patches) {
    std::vector<float> values;
    for (std::uint32_t k = 0; k < lattice::texel_count(int(patch.level)); ++k)
      for (int c = 0; c < LatticeTexture::channels; ++c)
        values.push_back(texture.value(std::size_t(patch.first_texel) + k, c));
    known.insert(std::move(values));
  }
  return known.size();
}

/// Faces that a lower level says: what shows of their features to half a step of 8 bits, their
/// cut-out exactly; and those that are transparent throughout.
std::size_t faces_that_fit_lower(const LatticeTexture& texture) {
  const std::vector<std::uint8_t> levels = smallest_levels(texture);
  std::size_t count = 0;
  for (std::size_t t = 0; t < levels.size(); ++t)
    count += levels[t] < texture.patches[t].level ? 1 : 0;
  return count;
}

/// Of so many random texels those whose colour moves by at most a step over 256 directions.
std::size_t view_independent_texels(const LatticeTexture& texture, std::size_t samples) {
  Random random(1);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 256; ++i) directions.push_back(random.direction());
  std::size_t count = 0;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t texel = random.below(std::uint32_t(texture.texel_count()));
    double features[LatticeTexture::features];
    for (int c = 0; c < LatticeTexture::features; ++c) features[c] = texture.value(texel, c);
    glm::dvec3 low(1), high(0);
    for (const glm::dvec3& direction : directions) {
      const glm::dvec3 color = evaluate(*texture.mlp, features, direction);
      low = glm::min(low, color);
      high = glm::max(high, color);
    }
    const glm::dvec3 range = high - low;
    count += std::max({range.x, range.y, range.z}) <= 2 * half_step ? 1 : 0;
  }
  return count;
}

void audit(const std::filesystem::path& path) {
  Scene scene = read_scene(path);
  const std::string name = path.stem().string();
  const auto* texture = std::get_if<LatticeTexture>(&opaque_soup(scene).appearance);
  if (!texture) {
    std::printf("| %s | no lattice texture | | | | |\n", name.c_str());
    return;
  }
  const std::size_t faces = texture->patches.size();
  std::printf("| %s | %zu | %zu | %zu |", name.c_str(), faces, distinct_lattices(*texture),
              faces_that_fit_lower(*texture));
  if (texture->mlp && texture->texel_count() > 0) {
    constexpr std::size_t samples = 4000;
    std::printf(" %zu of %zu |", view_independent_texels(*texture, samples), samples);
    if (texture->mlp->blend_channel)
      std::printf(" %zu of %zu |", unblended_texels(*texture, *texture->mlp->blend_channel),
                  texture->texel_count());
    else
      std::printf(" |");
  } else {
    std::printf(" | |");
  }
  std::puts("");
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  try {
    std::puts(
        "| soup | faces | with a lattice of their own (L4) | said to half a step by a lower level "
        "(L3) | of random texels: colour within a step over 256 directions (M3) | texels with a "
        "blend of at most 1/510 (M6) |\n|---|---|---|---|---|---|");
    for (int i = 1; i < argc; ++i) tureen::test::audit(argv[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "leave_out_audit: %s\n", error.what());
    return 1;
  }
}
