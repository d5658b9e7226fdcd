// Gaussian splats of a foreign glTF file: primitives of points with KHR_gaussian_splatting
// (https://github.com/KhronosGroup/glTF, extensions/2.0/Khronos/KHR_gaussian_splatting).
//
// Supported: the kernel "ellipse", harmonics of degree 0 to 3, and every component type that the
// specification allows, also strided or sparse. The profile is "3dgs", the method that the
// specification describes. Splats are ordered by view depth, whatever `sortingMethod` is.
// KHR_gaussian_splatting_compression_spz_2 (a draft, KhronosGroup/glTF pull request 2531): the
// splats are an SPZ file in a buffer view; the attributes are ignored. The draft turns the stored
// axes, right, up, back, to left, up, front. Files without kernel and colour space, which the
// extension below it requires by now, are older, and their stored axes are those of the node.
// Not supported: other kernels and projections, primitives with indices, and nodes that stretch or
// shear. They are rejected. Linear colours are not converted, with a remark: neither a polynomial
// of harmonics nor blending commutes with the sRGB curve.
#pragma once

#include <string>
#include <vector>

#include "formats/gltf/gltf.hpp"
#include "formats/gltf/gltf_document.hpp"
#include "scene/scene.hpp"

namespace tureen {

bool has_splats(const tinygltf::Primitive& primitive);

class GltfSplatBuilder {
 public:
  /// Uses the options `keep_rows` and, for SPZ files, `max_splats`. Rows are elements of the
  /// accessors or of an SPZ file. `read_spz`: null where SPZ files are not supported.
  GltfSplatBuilder(GltfDocument& document, const ReadOptions& options, ReadSpz read_spz)
      : document_(document), options_(options), read_spz_(read_spz) {}

  /// A node with a mesh.
  struct Node {
    std::string name;
    glm::dmat4 world_from_node;
  };

  /// Adds a layer for each primitive with splats of meshes[index]; the index is valid. `where` is
  /// the node's place in errors. Splats are dropped unless is_valid() and unit_rotation() accept
  /// them. Throws InputError.
  void add_mesh(int index, const Node& node, const std::string& where);

  /// The layers so far, in the order of the nodes. Their splats are in Morton order and have no
  /// defect().
  std::vector<Layer>& layers() { return layers_; }

  std::vector<Remark> remarks() const;

 private:
  Splats read(const tinygltf::Primitive& primitive, const std::string& where);
  /// Appends the splats of an SPZ file. `extension` holds its buffer view.
  void add_spz(const tinygltf::Value& extension, Layer layer, bool is_older,
               const std::string& where);
  void check_method(const tinygltf::Primitive& primitive, const std::string& where);
  std::vector<float> attribute(const tinygltf::Primitive& primitive, const std::string& name,
                               int components, const std::string& where);
  void require_normalized(const tinygltf::Primitive& primitive, const std::string& name,
                          const std::string& where) const;
  int degree_of(const tinygltf::Primitive& primitive, const std::string& where) const;

  GltfDocument& document_;
  const ReadOptions& options_;
  ReadSpz read_spz_;
  std::vector<Remark> spz_remarks_;
  std::vector<Layer> layers_;
  std::vector<std::uint32_t> all_;  // 0, 1, .. of the current primitive
  std::uint64_t total_ = 0, dropped_ = 0;
  bool is_linear_ = false;
};

}  // namespace tureen
