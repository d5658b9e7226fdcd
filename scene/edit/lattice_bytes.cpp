#include "scene/edit/lattice_bytes.hpp"

#include "image/quantise.hpp"

namespace tureen {

void round_to_bytes(LatticeTexture& texture) {
  const auto* values = std::get_if<std::vector<float>>(&texture.texels);
  if (!values) return;
  std::vector<std::uint8_t> bytes(values->size());
  constexpr std::size_t channels = LatticeTexture::channels;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_alpha = i % channels == LatticeTexture::features;
    bytes[i] = is_alpha ? quantised_alpha((*values)[i]) : quantised_unit((*values)[i]);
  }
  texture.texels = std::move(bytes);
}

}  // namespace tureen
