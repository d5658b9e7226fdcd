#include "formats/glb/glb_arrays.hpp"

#include <algorithm>

namespace tureen {

namespace {

std::size_t component_bytes(int type) {
  switch (type) {
    case glb_layout::unsigned_byte:
      return 1;
    case glb_layout::unsigned_short:
      return 2;
    default:
      return 4;
  }
}

}  // namespace

GlbArrays::GlbArrays(Input& input, const GlbContainer& glb, std::function<void(double)> progress)
    : input_(input), glb_(glb), progress_(std::move(progress)), root_(glb.json, input.name()) {}

GlbArrays::Location GlbArrays::in_binary_chunk(const JsonView& view) const {
  if (view["buffer"].natural() != 0) view.fail("is not in the binary chunk");
  const std::uint64_t size = view["byteLength"].natural();
  const auto offset_member = view.find("byteOffset");
  const std::uint64_t offset = offset_member ? offset_member->natural() : 0;
  if (offset > glb_.binary_size || size > glb_.binary_size - offset)
    view.fail("bytes " + std::to_string(offset) + " + " + std::to_string(size) +
              " lie outside of the binary chunk of " + std::to_string(glb_.binary_size));
  if (offset < first_byte_)
    view.fail("byte " + std::to_string(offset) +
              " lies before the end of the previous layer's arrays, " +
              std::to_string(first_byte_));
  end_ = std::max(end_, offset + size);
  return {glb_.binary_offset + offset, size};
}

GlbArrays::Location GlbArrays::view_location(const JsonView& reference) const {
  return in_binary_chunk(root_["bufferViews"].at(index(reference)));
}

JsonView GlbArrays::accessor(const JsonView& reference) const {
  return root_["accessors"].at(index(reference));
}

GlbArrays::Location GlbArrays::location(const JsonView& holder, const char* key,
                                        std::uint64_t elements, const Format& format) const {
  const auto reference = holder.find(key);
  if (!reference && elements != 0) holder.fail(std::string("lacks \"") + key + "\"");
  if (!reference) return {};
  const JsonView accessor = this->accessor(*reference);
  if (accessor["type"].text() != format.type)
    accessor["type"].fail(std::string("expected ") + format.type);
  if (accessor["componentType"].natural() != std::uint64_t(format.component_type))
    accessor["componentType"].fail("expected " + std::to_string(format.component_type));
  if (accessor.find("sparse")) accessor.fail("is sparse, which this extension does not use");
  const std::size_t each = component_bytes(format.component_type) * format.components;
  const std::uint64_t count =
      accessor["count"].natural(std::numeric_limits<std::uint64_t>::max() / 64);
  const JsonView view = root_["bufferViews"].at(index(accessor["bufferView"]));
  if (const auto stride = view.find("byteStride"); stride && stride->natural() != each)
    view.fail("has a stride, but this extension packs tightly");
  const Location bytes = in_binary_chunk(view);
  const auto offset_member = accessor.find("byteOffset");
  const std::uint64_t offset = offset_member ? offset_member->natural() : 0;
  if (offset > bytes.size || count > (bytes.size - offset) / each)
    accessor.fail(std::to_string(count) + " elements of " + std::to_string(each) +
                  " bytes do not fit into its buffer view of " + std::to_string(bytes.size));
  if (count != elements)
    reference->fail("its accessor has " + std::to_string(count) + " elements, expected " +
                    std::to_string(elements));
  return {bytes.offset + offset, count * each};
}

void GlbArrays::tell_progress() const {
  if (progress_) progress_(double(input_.position()) / double(input_.size()));
}

}  // namespace tureen
