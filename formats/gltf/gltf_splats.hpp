// Gaussian splats of a foreign glTF file: primitives of points with KHR_gaussian_splatting
// (https://github.com/KhronosGroup/glTF, extensions/2.0/Khronos/KHR_gaussian_splatting).
//
// Supported: the kernel "ellipse", harmonics of degree 0 to 3, and every component type that the
// specification allows, also strided or sparse. The profile is "3dgs", the method that the
// specification describes. Splats are ordered by view depth, whatever `sortingMethod` is.
// Not supported: other kernels and projections, primitives with indices, and nodes that stretch or
// shear. They are rejected. Linear colours are not converted, with a remark: neither a polynomial
// of harmonics nor blending commutes with the sRGB curve.
#pragma once

#include <string>
#include <vector>

#include "formats/gltf/gltf_document.hpp"
#include "scene/scene.hpp"

namespace tureen {

bool has_splats(const tinygltf::Primitive& primitive);

class GltfSplatBuilder {
 public:
  explicit GltfSplatBuilder(GltfDocument& document) : document_(document) {}

  /// A node with a mesh.
  struct Node {
    std::string name;
    glm::dmat4 world_from_node;
  };

  /// Adds a layer for each primitive with splats of meshes[index]; the index is valid. `where` is
  /// the node's place in errors. Splats are dropped by the rules of
  /// formats/common/splat_values.hpp. Throws InputError.
  void add_mesh(int index, const Node& node, const std::string& where);

  /// The layers so far, in the order of the nodes. Their splats are in Morton order and have no
  /// defect().
  std::vector<Layer>& layers() { return layers_; }

  std::vector<Remark> remarks() const;

 private:
  Splats read(const tinygltf::Primitive& primitive, const std::string& where);
  void check_method(const tinygltf::Primitive& primitive, const std::string& where);
  std::vector<float> attribute(const tinygltf::Primitive& primitive, const std::string& name,
                               int components, const std::string& where);
  void require_normalized(const tinygltf::Primitive& primitive, const std::string& name,
                          const std::string& where) const;
  int degree_of(const tinygltf::Primitive& primitive, const std::string& where) const;
  void drop_invalid(Splats& splats, std::vector<glm::vec4>& rotations);

  GltfDocument& document_;
  std::vector<Layer> layers_;
  std::vector<std::uint32_t> all_;  // 0, 1, .. of the current primitive
  std::uint64_t total_ = 0, dropped_ = 0;
  bool is_linear_ = false;
};

}  // namespace tureen
