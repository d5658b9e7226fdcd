#include "formats/gltf_file.hpp"

#include <utility>

#include "formats/common/format_remarks.hpp"
#include "formats/glb/glb_container.hpp"
#include "formats/gltf/gltf.hpp"
#include "formats/gltf/gltf_meshopt.hpp"
#include "formats/splat/spz.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"

namespace tureen {

// A page lacks the libraries: zlib, zstd, meshoptimizer.
#ifdef __EMSCRIPTEN__
const GltfDecoders gltf_decoders;
#else
const GltfDecoders gltf_decoders{.spz = read_spz, .meshopt = decode_meshopt};
#endif

Scene read_gltf_or_glb(const std::filesystem::path& path, const ReadOptions& options,
                       const GltfDecoders& decoders) {
  Input input = Input::open(path);
  return read_gltf_or_glb(input, path.parent_path(), options, decoders);
}

Scene read_gltf_or_glb(Input& input, const std::filesystem::path& folder,
                       const ReadOptions& options, const GltfDecoders& decoders) {
  const bool binary = is_glb(input);
  GlbContainer glb = binary ? read_glb_container(input) : read_gltf_json(input);
  const bool ours = is_tureen_glb(glb);
  if (binary && ours) return read_tureen_glb(input, glb, options);
  const bool is_aligned = glb.is_aligned;
  Scene scene = read_gltf(input, std::move(glb), folder, options, decoders);
  if (!is_aligned) scene.info.remarks.push_back({&remarks::chunks_unaligned});
  if (ours)
    scene.info.remarks.push_back({&remarks::mean_colors_shown, {{"extension", tureen_extension}}});
  return scene;
}

}  // namespace tureen
