#include "web/engine/prepared_archive.hpp"

#include <cassert>
#include <cstring>

#include "splatting/layer.hpp"
#include "web/engine/archive.hpp"

namespace tureen::web {

namespace {

// One function per type, for both directions. Each names all members of its type in a structured
// binding, so that a new member does not compile until it is archived or left out on purpose. Types
// that can be copied by their bytes, such as Quality and SplatProfile, need no function.

template <class Archive, class Value>
void archive_layer_plan(Archive& archive, Value& value) {
  auto& [site, shading_stage, faces, opaque_count, clusters, drops_small_triangles, flat_colors,
         color_mlp, mlp_weights, view_direction, latent_features, depth_rejects_background,
         harmonics_degree, feature_ranges, lattice, applied, appearance, soup_faces,
         undrawable_faces, zero_weights] = value;
  archive(site, shading_stage, faces, opaque_count, clusters, drops_small_triangles, flat_colors,
          color_mlp, mlp_weights, view_direction, latent_features, depth_rejects_background,
          harmonics_degree, feature_ranges);
  auto& [uniform_level, levels, alpha_by_cell, refused_alpha_cell_bytes] = lattice;
  archive(uniform_level, levels, alpha_by_cell, refused_alpha_cell_bytes);
  archive(applied, appearance, soup_faces, undrawable_faces, zero_weights);
}

template <class Archive, class Value>
void archive_splat_plan(Archive& archive, Value& value) {
  auto& [kind, profile, as_published, harmonics_degree, colors_per_splat, largest_color, drawn,
         chunks, applied, kernel, splats] = value;
  archive(kind, profile, as_published, harmonics_degree, colors_per_splat, largest_color, drawn,
          chunks, applied, kernel, splats);
}

template <class Archive, class Value>
void archive_plan(Archive& archive, Value& value) {
  bool of_splats = std::holds_alternative<SplatPlan>(value);
  archive(of_splats);
  if constexpr (!std::is_const_v<Value>)
    if (of_splats) value = SplatPlan{};
  if (of_splats)
    archive_splat_plan(archive, std::get<SplatPlan>(value));
  else
    archive_layer_plan(archive, std::get<SoupPlan>(value));
}

template <class Archive, class Value>
void archive_store(Archive& archive, Value& value) {
  auto& [format, count, what, fill, store] = value;  // `fill` reads a blob; no store exists yet
  archive(format, count, what);
}

template <class Archive, class Value>
void archive_splats(Archive& archive, Value& value) {
  auto& [layout, kernel, coefficients, centers] = value;
  archive(layout);
  archive_store(archive, kernel);
  archive_store(archive, coefficients);
  archive(centers);
}

template <class Archive, class Value>
void archive_tiled_splats(Archive& archive, Value& value) {
  auto& [kind, degree, rows] = value;  // a blob has the values of the rows
  archive(kind, degree);
  std::size_t row_count = rows.rows(), count = rows.count();
  archive(row_count, count);
  if constexpr (!std::is_const_v<Value>) rows = splatting::ParameterRows(row_count, count);
}

/// Archives the number of elements, so that reading creates them, and each of them.
template <class Archive, class List, class Each>
void archive_list(Archive& archive, List& list, const Each& each) {
  std::size_t count = list.size();
  archive(count);
  if constexpr (!std::is_const_v<List>) list.resize(count);
  for (auto& element : list) each(archive, element);
}

template <class Archive, class Value>
void archive_soup(Archive& archive, Value& value) {
  auto& [appearance, geometry] = value;
  auto& [glsl, constants, samplers, mlp, layout] = appearance;
  archive(glsl, constants);
  archive_list(archive, samplers, [](auto& to, auto& sampler) {
    auto& [name, source] = sampler;
    to(name);
    archive_store(to, source);
  });
  auto& [text, weights, biases, hidden_neurons, dead_neurons, zero_weights, reads_features1] = mlp;
  archive(text, weights, biases, hidden_neurons, dead_neurons, zero_weights, reads_features1);
  archive(layout);
  auto& [face_count, fill] = geometry;  // `fill` reads a blob
  archive(face_count);
}

template <class Archive, class Value>
void archive_layer(Archive& archive, Value& value) {
  auto& [place, framed, soup, splats, tiled_splats] = value;
  auto& [bounds, world_from_layer, visible, name, material] = place;  // the page traces no rays
  archive(name, bounds, framed, world_from_layer, visible);
  bool of_splats = splats.has_value(), of_tiles = tiled_splats.has_value();
  archive(of_splats, of_tiles);
  if constexpr (!std::is_const_v<Value>) {
    if (of_splats)
      splats.emplace();
    else if (of_tiles)
      tiled_splats.emplace();
    else
      soup.emplace();
  }
  if (of_splats)
    archive_splats(archive, *splats);
  else if (of_tiles)
    archive_tiled_splats(archive, *tiled_splats);
  else
    archive_soup(archive, soup.value());  // the page's instance makes no passes from outside
}

template <class Archive, class Value>
void archive_scene(Archive& archive, Value& value) {
  auto& [plan, layers, make_passes] = value;
  auto& [reversed_depth, quality, specialise, requested_stage, layer_plans, splats_in_tiles,
         description] = plan;
  archive(reversed_depth, quality, specialise, requested_stage);
  archive_list(archive, layer_plans, [](auto& to, auto& layer) {
    if constexpr (std::is_const_v<Value>)
      archive_plan(to, std::as_const(*layer));
    else
      archive_plan(to, *(layer = std::make_shared<LayerPlan>()));
  });
  archive(splats_in_tiles, description);
  archive_list(archive, layers, [](auto& to, auto& layer) { archive_layer(to, layer); });
}

/// The contents of a blob: one of these.
struct Blob {
  const PreparedSoup* soup = nullptr;  // its corners
  const TexelSource* store = nullptr;
  const splatting::ParameterRows* rows = nullptr;
  TexelLayout layout = {};  // of the store
};

/// Blobs of a layer.
std::size_t blobs_of(const PreparedLayer& layer) {
  if (layer.tiled_splats) return 1;
  return layer.splats ? 2 : 1 + layer.soup->appearance.samplers.size();
}

Blob blob_of(const PreparedLayer& layer, std::size_t index) {
  if (layer.tiled_splats) return {.rows = &layer.tiled_splats->rows};
  if (layer.splats)
    return {.store = index == 0 ? &layer.splats->kernel : &layer.splats->coefficients,
            .layout = layer.splats->layout};
  if (index == 0) return {.soup = &*layer.soup};
  const AppearanceSource& appearance = layer.soup->appearance;
  return {.store = &appearance.samplers[index - 1].source, .layout = appearance.layout};
}

Blob blob_at(const PreparedScene& prepared, std::size_t index) {
  for (const PreparedLayer& layer : prepared.layers) {
    const std::size_t count = blobs_of(layer);
    if (index < count) return blob_of(layer, index);
    index -= count;
  }
  assert(!"no such blob");
  return {};
}

}  // namespace

std::vector<std::byte> pack_head(const PreparedScene& prepared) {
  ArchiveWriter archive;
  archive_scene(archive, prepared);
  return archive.take();
}

std::size_t blob_count(const PreparedScene& prepared) {
  std::size_t count = 0;
  for (const PreparedLayer& layer : prepared.layers) count += blobs_of(layer);
  return count;
}

std::uint64_t blob_size(const PreparedScene& prepared, std::size_t blob) {
  const auto [soup, store, rows, layout] = blob_at(prepared, blob);
  if (rows) return rows->values().size_bytes();
  return store ? store->count * store->format.bytes
               : soup->geometry.face_count * sizeof(FaceCorners);
}

std::size_t blob_grain(const PreparedScene& prepared, std::size_t blob) {
  const auto [soup, store, rows, layout] = blob_at(prepared, blob);
  if (rows) return sizeof(float);
  return store ? std::size_t(layout.row_texels()) * store->format.bytes : sizeof(FaceCorners);
}

void read_blob(const PreparedScene& prepared, std::size_t blob, std::uint64_t offset,
               std::span<std::byte> out) {
  const auto [soup, store, rows, layout] = blob_at(prepared, blob);
  if (rows) {
    const auto bytes = std::as_bytes(rows->values());
    std::memcpy(out.data(), bytes.data() + offset, out.size());
    return;
  }
  if (store) {
    store->fill(offset / store->format.bytes, out);
    return;
  }
  std::vector<FaceCorners> corners(out.size() / sizeof(FaceCorners));
  soup->geometry.fill(static_cast<std::size_t>(offset / sizeof(FaceCorners)), corners);
  std::memcpy(out.data(), corners.data(), out.size());
}

PreparedScene unpack(std::span<const std::byte> head, const BlobReader& read) {
  PreparedScene prepared;
  ArchiveReader archive(head);
  archive_scene(archive, prepared);
  std::size_t blob = 0;
  const auto fill_from = [&](TexelSource& source) {
    source.fill = [&read, blob, each = source.format.bytes](std::uint64_t first,
                                                            std::span<std::byte> out) {
      read(blob, first * each, out);
    };
    ++blob;
  };
  for (PreparedLayer& layer : prepared.layers) {
    if (layer.tiled_splats) {
      ++blob;
      continue;
    }
    if (layer.splats) {
      fill_from(layer.splats->kernel);
      fill_from(layer.splats->coefficients);
      continue;
    }
    layer.soup->geometry.fill = [&read, blob](std::size_t first, std::span<FaceCorners> out) {
      read(blob, first * sizeof(FaceCorners), std::as_writable_bytes(out));
    };
    ++blob;
    for (AppearanceSource::Sampler& sampler : layer.soup->appearance.samplers)
      fill_from(sampler.source);
  }
  return prepared;
}

void read_rows(PreparedScene& prepared, const BlobReader& read) {
  std::size_t blob = 0;
  for (PreparedLayer& layer : prepared.layers) {
    if (layer.tiled_splats)
      read(blob, 0, std::as_writable_bytes(layer.tiled_splats->rows.values()));
    blob += blobs_of(layer);
  }
}

BlobStore store_of(PreparedScene& prepared, std::size_t blob) {
  const Blob found = blob_at(prepared, blob);
  return {const_cast<TexelSource*>(found.store), found.layout};
}

}  // namespace tureen::web
