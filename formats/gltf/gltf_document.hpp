// A foreign glTF file: its JSON as tinygltf's model, and checked access to its bytes.
//
// tinygltf receives the JSON without buffers and images and has no file system. It can therefore
// neither open files nor read binary data. This class loads buffers and images on demand from the
// binary chunk, from data URIs, or from files in the scene's folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/json/json_view.hpp"
#include "formats/glb/glb_container.hpp"
#include "formats/gltf/gltf.hpp"
#include "formats/gltf/tinygltf.hpp"
#include "image/image.hpp"

namespace tureen {

class GltfDocument {
 public:
  /// `glb` is the container in `input`, or the JSON of a whole .gltf. Throws InputError if it is
  /// not glTF 2.0 or requires an unsupported extension. The input must outlive this object.
  GltfDocument(Input& input, GlbContainer glb, std::filesystem::path folder,
               const GltfDecoders& decoders);

  const tinygltf::Model& model() const { return model_; }
  const std::string& name() const { return input_.name(); }
  JsonView root() const { return {glb_.json, input_.name()}; }

  struct Elements {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
  };
  /// Checks `count` elements in a buffer view, from byte `offset`. An element has `each` bytes.
  /// Returns the first element and the distance between elements: the view's stride, or `each` if
  /// the view has none. The reason of an error begins with `where`.
  Elements elements(int view, std::uint64_t offset, std::uint64_t count, std::size_t each,
                    const std::string& where);

  Image8 image(int index);

  /// The bytes of a buffer view, decompressed; they live as long as this object.
  std::span<const std::byte> view_bytes(int view, const std::string& where);

  /// Extensions that the file uses and that are not applied; at most 8.
  std::vector<std::string> dropped_extensions() const;

  /// Counts memory before its allocation; fails at `where` beyond the budget.
  void take_memory(std::uint64_t elements, std::size_t each, const std::string& where) const;
  /// Calls make_room (base/memory_budget.hpp); fails at `where`.
  template <class T>
  void make_room_in(std::vector<T>& values, std::size_t more, const std::string& where) {
    MemoryBudget budget = input_.budget();
    if (!make_room(values, more, budget))
      fail(where, budget.refusal(where.empty() ? "the scene" : "it"), max_memory_hint);
  }
  MemoryBudget budget() const { return input_.budget(); }

  /// The limit on the vertices of the loaded scene: 2^24, or the number of loaded bytes if that is
  /// larger. It also limits the elements of an accessor without a buffer view. A stored vertex
  /// takes at least three bytes. A scene therefore exceeds the limit only if several nodes or
  /// primitives repeat the same stored vertices, or if accessors have no buffer view.
  std::uint64_t vertex_budget() const;

  [[noreturn]] void fail(const std::string& where, const std::string& reason,
                         const std::string& hint = {}) const;

 private:
  std::span<const std::byte> buffer(int index, const std::string& where);
  std::span<const std::byte> buffer_bytes(int buffer, std::uint64_t offset, std::uint64_t size,
                                          const std::string& where);
  std::span<const std::byte> decoded_view(int view, const JsonView& extension);
  std::vector<std::byte> load_buffer(std::size_t index, std::uint64_t size);
  std::vector<std::byte> load_uri(const JsonView& uri, std::optional<std::uint64_t> size);
  void take_model_memory() const;
  void parse();

  Input& input_;
  GlbContainer glb_;
  std::filesystem::path folder_;
  tinygltf::Model model_;
  GltfDecoders decoders_;
  bool has_meshopt_ = false;
  std::vector<std::optional<std::vector<std::byte>>> buffers_;
  std::map<int, std::vector<std::byte>> decoded_views_;  // by buffer view
  std::uint64_t loaded_bytes_ = 0;                       // of buffers
};

}  // namespace tureen
