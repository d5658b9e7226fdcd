// The visible face of each pixel.
//
// A triangle's rectangle on an image is divided into pieces, each the work of one warp, so that
// many threads share a large triangle. The kernels project the faces, count their pieces and sum
// the counts. Each warp then finds its next piece in these sums. One atomic maximum per pixel
// selects the nearest fragment, so the order of fragments does not matter.
#pragma once

#include "scene/triangle_soup.hpp"
#include "trainer/common/kernels/random.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cuda/device_image.hpp"

namespace tureen::trainer::cuda {

inline constexpr unsigned warp_size = 32;
inline constexpr int piece_width = 32, piece_height = 8;

/// Faces on images: entry image * faces + face.
struct Projections {
  kernels::ProjectedFace* faces;
  std::uint64_t* first_piece;  // counts, then their sums; projections + 1 entries
};

TUREEN_HOST_DEVICE unsigned piece_columns(const kernels::ProjectedFace& face) {
  return unsigned(face.x1 - face.x0 + piece_width - 1) / piece_width;
}

/// Projects faces and counts their pieces. One thread per projection.
struct ProjectFaces {
  static constexpr unsigned threads = 128;
  using Shared = Nothing;
  using Local = Nothing;
  DeviceBatch batch;
  DeviceModel model;
  Projections out;

  TUREEN_HOST_DEVICE unsigned phases() const { return 1; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned, const Thread& at, Shared&, Local&) const {
    const std::size_t i = std::size_t(at.block) * threads + at.thread;
    if (i >= model.faces * batch.count) return;
    const std::size_t face = i % model.faces;
    const kernels::ProjectedFace projected =
        kernels::project(batch.images[i / model.faces].view, model.positions + 9 * face);
    out.faces[i] = projected;
    const unsigned rows =
        unsigned(projected.y1 - projected.y0 + piece_height - 1) / unsigned(piece_height);
    out.first_piece[i] = projected.empty() ? 0 : std::uint64_t(piece_columns(projected)) * rows;
  }
};

/// Replaces each count by the sum of all counts before it. One block.
struct SumPieces {
  static constexpr unsigned threads = 1024;
  struct Shared {
    std::uint64_t sums[threads];
  };
  using Local = Nothing;
  std::uint64_t* first_piece;
  std::size_t count;

  TUREEN_HOST_DEVICE unsigned phases() const { return 3; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared, Local&) const {
    const std::size_t each = (count + threads - 1) / threads;
    const std::size_t begin = at.thread * each < count ? at.thread * each : count;
    const std::size_t end = begin + each < count ? begin + each : count;
    if (phase == 0) {
      std::uint64_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += first_piece[i];
      shared.sums[at.thread] = sum;
    } else if (phase == 1 && at.thread == 0) {
      std::uint64_t sum = 0;
      for (std::uint64_t& before : shared.sums) {
        const std::uint64_t own = before;
        before = sum;
        sum += own;
      }
      first_piece[count] = sum;
    } else if (phase == 2) {
      std::uint64_t sum = shared.sums[at.thread];
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint64_t own = first_piece[i];
        first_piece[i] = sum;
        sum += own;
      }
    }
  }
};

/// A piece of a projection's rectangle.
struct Piece {
  std::size_t projection;
  unsigned image;
  std::uint32_t face;
  int x0, y0;
  unsigned width, height;
};

TUREEN_HOST_DEVICE Piece piece_of(const Projections& projections, std::size_t count,
                                  std::size_t faces, std::uint64_t index) {
  Piece piece;
  piece.projection = interval_of(projections.first_piece, count, index);
  piece.image = unsigned(piece.projection / faces);
  piece.face = std::uint32_t(piece.projection % faces);
  const kernels::ProjectedFace& face = projections.faces[piece.projection];
  const unsigned within = unsigned(index - projections.first_piece[piece.projection]);
  const unsigned columns = piece_columns(face);
  piece.x0 = face.x0 + int(within % columns) * piece_width;
  piece.y0 = face.y0 + int(within / columns) * piece_height;
  piece.width = unsigned(face.x1 - piece.x0 < piece_width ? face.x1 - piece.x0 : piece_width);
  piece.height = unsigned(face.y1 - piece.y0 < piece_height ? face.y1 - piece.y0 : piece_height);
  return piece;
}

/// Calls visit(piece, projected) for the pieces of this thread's warp: every n-th for n warps.
template <class Visitor>
TUREEN_HOST_DEVICE void for_each_own_piece(const DeviceBatch& batch, const Projections& projections,
                                           std::size_t faces, const Thread& at, unsigned threads,
                                           Visitor&& visit) {
  const unsigned warps = threads / warp_size;
  const std::size_t count = faces * batch.count;
  const std::uint64_t pieces = projections.first_piece[count];
  for (std::uint64_t i = std::uint64_t(at.block) * warps + at.thread / warp_size; i < pieces;
       i += std::uint64_t(at.blocks) * warps) {
    const Piece piece = piece_of(projections, count, faces, i);
    visit(piece, projections.faces[piece.projection]);
  }
}

/// Calls visit(fragment) for the thread's share of a piece's pixels.
template <class Visitor>
TUREEN_HOST_DEVICE void for_each_own_fragment(const kernels::View& view, const Piece& piece,
                                              const kernels::ProjectedFace& face, const Thread& at,
                                              Visitor&& visit) {
  for (unsigned i = at.thread % warp_size; i < piece.width * piece.height; i += warp_size) {
    kernels::Fragment fragment;
    if (kernels::fragment_at(view, face, piece.x0 + int(i % piece.width),
                             piece.y0 + int(i / piece.width), fragment))
      visit(fragment);
  }
}

/// Writes the visible face of each pixel to `keys`, which must be zero.
struct FindVisible {
  static constexpr unsigned threads = 256;
  struct Shared {
    unsigned long long fragments[threads];
  };
  using Local = Nothing;
  DeviceBatch batch;
  DeviceModel model;
  Projections projections;
  Masking masking;
  VisibleKey* keys;               // one per pixel
  unsigned long long* fragments;  // added to: pixel centres that triangles cover

  TUREEN_HOST_DEVICE unsigned phases() const { return 2; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared, Local&) const {
    if (phase == 1) {
      if (at.thread != 0) return;
      unsigned long long sum = 0;
      for (const unsigned long long own : shared.fragments) sum += own;
      Atomics::add(*fragments, sum);
      return;
    }
    unsigned long long count = 0;
    for_each_own_piece(batch, projections, model.faces, at, threads,
                       [&](const Piece& piece, const kernels::ProjectedFace& projected) {
                         count += find<Atomics>(piece, projected, at);
                       });
    shared.fragments[at.thread] = count;
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE unsigned find(const Piece& piece, const kernels::ProjectedFace& projected,
                                   const Thread& at) const {
    unsigned count = 0;
    const DeviceImage& image = batch.images[piece.image];
    const float* alpha = model.alpha + piece.face * model.fine_texels();
    for_each_own_fragment(image.view, piece, projected, at, [&](const kernels::Fragment& fragment) {
      ++count;
      const std::size_t pixel =
          std::size_t(fragment.y) * std::size_t(image.view.width) + std::size_t(fragment.x);
      VisibleKey& visible = keys[image.first_pixel + pixel];
      const VisibleKey key = visible_key(fragment.inverse_depth, piece.face);
      // Keys only grow: a key below an old value is below the current one too.
      if (key <= Atomics::load(visible)) return;
      const float a = lattice::interpolated(
          lattice::footprint(model.max_level, fragment.b0, fragment.b1), alpha);
      const float needed =
          masking == Masking::threshold
              ? alpha_threshold
              : kernels::uniform_draw(image.draw_key, std::uint32_t(pixel), piece.face);
      if (a >= needed) Atomics::maximum(visible, key);
    });
    return count;
  }
};

/// Counts the visible pixels of each face. One thread per pixel of the batch.
struct CountVisible {
  static constexpr unsigned threads = 256;
  using Shared = Nothing;
  using Local = Nothing;
  const VisibleKey* keys;
  std::size_t pixels;
  unsigned long long* counts;  // one per face

  TUREEN_HOST_DEVICE unsigned phases() const { return 1; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned, const Thread& at, Shared&, Local&) const {
    const std::size_t pixel = std::size_t(at.block) * threads + at.thread;
    if (pixel < pixels && keys[pixel] != 0) Atomics::add(counts[face_of(keys[pixel])], 1ull);
  }
};

}  // namespace tureen::trainer::cuda
