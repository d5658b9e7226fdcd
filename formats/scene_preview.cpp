#include "formats/scene_preview.hpp"

#include "formats/splat/splat_preview.hpp"
#include "formats/tureen_glb/tureen_glb_preview.hpp"

namespace tureen {

std::optional<PreviewSize> preview_size(std::span<const std::byte> prefix, const std::string& name,
                                        std::uint64_t shown) {
  const std::optional<PreviewSize> ours = tureen_glb_preview_size(prefix, name);
  if (!ours) return std::nullopt;
  if (ours->bytes > 0) return shown == 0 ? *ours : PreviewSize{};
  return splat_preview_size(prefix, name, shown);
}

std::optional<Scene> read_preview(std::span<const std::byte> prefix, const std::string& name) {
  if (auto ours = read_tureen_glb_preview(prefix, name)) return ours;
  return read_splat_preview(prefix, name);
}

}  // namespace tureen
