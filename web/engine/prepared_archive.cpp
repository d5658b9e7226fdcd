#include "web/engine/prepared_archive.hpp"

#include "web/engine/archive.hpp"

namespace tureen::web {

namespace {

// One function per type lists its archived members, for both directions.

template <class Archive, class Plan>
void archive_plan(Archive& archive, Plan& plan) {
  archive(plan.site, plan.reversed_depth, plan.faces, plan.opaque_count, plan.clusters,
          plan.drops_small_triangles, plan.flat_colors, plan.color_mlp, plan.mlp_weights,
          plan.view_direction, plan.latent_features, plan.depth_rejects_background,
          plan.harmonics_degree, plan.feature_ranges, plan.lattice.uniform_level,
          plan.lattice.levels, plan.lattice.alpha_by_cell, plan.lattice.refused_alpha_cell_bytes,
          plan.applied, plan.shading_stage, plan.quality.resolution_scale,
          plan.quality.supersampling, plan.appearance, plan.soup_faces, plan.undrawable_faces,
          plan.zero_weights, plan.specialise, plan.requested_stage);
}

template <class Archive, class Network>
void archive_network(Archive& archive, Network& mlp) {
  archive(mlp.text, mlp.weights, mlp.biases, mlp.hidden_neurons, mlp.dead_neurons, mlp.zero_weights,
          mlp.reads_features1);
}

template <class Archive, class Sampler>
void archive_sampler(Archive& archive, Sampler& sampler) {
  archive(sampler.name, sampler.source.format, sampler.source.count, sampler.source.what);
}

template <class Archive, class Prepared>
void archive_head(Archive& archive, Prepared& prepared) {
  archive_plan(archive, prepared.plan);
  archive(prepared.bounds, prepared.origin, prepared.geometry.face_count, prepared.appearance.glsl,
          prepared.appearance.constants, prepared.appearance.layout);
  archive_network(archive, prepared.appearance.mlp);
}

const TexelSource& source_of(const PreparedSoup& prepared, std::size_t blob) {
  return prepared.appearance.samplers[blob - 1].source;
}

}  // namespace

std::vector<std::byte> pack_head(const PreparedSoup& prepared) {
  ArchiveWriter archive;
  archive_head(archive, prepared);
  archive(prepared.appearance.samplers.size());
  for (const auto& sampler : prepared.appearance.samplers) archive_sampler(archive, sampler);
  return archive.take();
}

std::size_t blob_count(const PreparedSoup& prepared) {
  return 1 + prepared.appearance.samplers.size();
}

std::uint64_t blob_size(const PreparedSoup& prepared, std::size_t blob) {
  const std::uint64_t count =
      blob == 0 ? prepared.geometry.face_count : source_of(prepared, blob).count;
  return count * blob_grain(prepared, blob);
}

std::size_t blob_grain(const PreparedSoup& prepared, std::size_t blob) {
  return blob == 0 ? sizeof(FaceCorners) : source_of(prepared, blob).format.bytes;
}

void read_blob(const PreparedSoup& prepared, std::size_t blob, std::uint64_t offset,
               std::span<std::byte> out) {
  const std::uint64_t first = offset / blob_grain(prepared, blob);
  if (blob > 0) {
    source_of(prepared, blob).fill(first, out);
    return;
  }
  std::vector<FaceCorners> corners(out.size() / sizeof(FaceCorners));
  prepared.geometry.fill(static_cast<std::size_t>(first), corners);
  std::memcpy(out.data(), corners.data(), out.size());
}

PreparedSoup unpack(std::span<const std::byte> head, const BlobReader& read) {
  PreparedSoup prepared;
  ArchiveReader archive(head);
  archive_head(archive, prepared);
  prepared.geometry.fill = [&read](std::size_t first, std::span<FaceCorners> out) {
    read(0, first * sizeof(FaceCorners), std::as_writable_bytes(out));
  };
  std::size_t samplers = 0;
  archive(samplers);
  prepared.appearance.samplers.resize(samplers);
  for (std::size_t i = 0; i < samplers; ++i) {
    AppearanceSource::Sampler& sampler = prepared.appearance.samplers[i];
    archive_sampler(archive, sampler);
    sampler.source.fill = [&read, blob = i + 1, each = sampler.source.format.bytes](
                              std::uint64_t first, std::span<std::byte> out) {
      read(blob, first * each, out);
    };
  }
  return prepared;
}

}  // namespace tureen::web
