#include "formats/tureen_glb/compressed_geometry.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "base/error.hpp"
#include "formats/tureen_glb/range_coder.hpp"

namespace tureen {

namespace {

/// The grid at the head of the stream: the corner of the box and the side of a cell.
struct Grid {
  glm::vec3 low{0.0f};
  float step = 1.0f;
};
static_assert(sizeof(Grid) == 16);

/// Temporary memory per face in bytes: indices, cells and positions of three vertices, times 3 for
/// vectors that double as they grow.
constexpr std::size_t bytes_a_face = 3 * (12 + 3 * 12 + 3 * 12);
/// Largest number of faces per stored byte, so that this memory stays within 4,096 bytes per stored
/// byte. The encoder pads smaller data.
constexpr std::uint64_t max_faces_per_byte = 16;
static_assert(bytes_a_face <= 4096 / max_faces_per_byte);

struct GeometryModels {
  BitModel known[3];
  NumberModel<26> distance[3];
  // By corner, axis and bit length of the previous difference of that corner and axis.
  SignedModel<25> difference[3][3][26];
};

int bit_length(int value) {
  int length = 0;
  for (unsigned rest = unsigned(value < 0 ? -value : value); rest != 0; rest >>= 1) ++length;
  return std::min(length, 25);
}

/// The traversal shared by encoder and decoder. The encoder passes its cells and triangles; the
/// decoder passes none and receives them.
template <class Coder>
class GeometryWalk {
 public:
  GeometryWalk(Coder& coder, std::span<const glm::ivec3> given) : coder_(coder), given_(given) {}

  /// Returns false if a corner refers to a missing vertex, or if there would be more than `limit`
  /// vertices.
  bool face(const glm::uvec3& wanted, std::size_t limit, glm::uvec3& face) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t made = cells.size();
      if (coder_.bit(models_->known[k], wanted[k] < made)) {
        const std::uint32_t back = wanted[k] < made ? std::uint32_t(made - 1 - wanted[k]) : 0;
        const std::uint32_t distance = models_->distance[k].code(coder_, back);
        if (distance >= made) return false;
        face[k] = std::uint32_t(made - 1 - distance);
      } else {
        if (made == limit) return false;
        face[k] = std::uint32_t(made);
        cells.push_back(cell(k, given_.empty() ? glm::ivec3(0) : given_[made]));
      }
      if (k == 0) first_ = cells[face[0]];
    }
    return true;
  }

  std::vector<glm::ivec3> cells;

 private:
  glm::ivec3 cell(int corner, const glm::ivec3& wanted) {
    glm::ivec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      int& length = lengths_[std::size_t(corner)][std::size_t(axis)];
      const int difference =
          models_->difference[corner][axis][length].code(coder_, wanted[axis] - first_[axis]);
      length = bit_length(difference);
      // Damaged bytes must not overflow an int.
      result[axis] = std::clamp(first_[axis] + difference, 0, 1 << max_compressed_bits);
    }
    return result;
  }

  Coder& coder_;
  std::span<const glm::ivec3> given_;
  std::unique_ptr<GeometryModels> models_ = std::make_unique<GeometryModels>();
  glm::ivec3 first_{0};  // first corner of this face, or of the previous one
  std::array<std::array<int, 3>, 3> lengths_{};
};

/// The geometry with vertices in the order of their first use.
CompressedGeometry in_order_of_use(const CompressedGeometry& geometry) {
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> place(geometry.positions.size(), unused);
  CompressedGeometry result;
  for (glm::uvec3 triangle : geometry.triangles) {
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& at = place[triangle[k]];
      if (at == unused) {
        at = std::uint32_t(result.positions.size());
        result.positions.push_back(geometry.positions[triangle[k]]);
      }
      triangle[k] = at;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

Grid grid_of(const std::vector<glm::vec3>& positions, int bits) {
  if (positions.empty()) return {};
  glm::vec3 low = positions.front(), high = low;
  for (const glm::vec3& p : positions)
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(p[k]))
        throw UsageError("a compressed file cannot hold a non-finite vertex");
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  double side = 0;
  for (int k = 0; k < 3; ++k) side = std::max(side, double(high[k]) - double(low[k]));
  const auto step = float(side / double((1 << bits) - 1));
  // Equal positions give a step of 0.
  return {low, step > 0.0f ? step : 1.0f};
}

}  // namespace

std::size_t used_vertices(std::span<const glm::uvec3> triangles) {
  std::vector<bool> used;
  std::size_t count = 0;
  for (const glm::uvec3& triangle : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::size_t vertex = triangle[k];
      if (vertex >= used.size()) used.resize(vertex + 1);
      if (!used[vertex]) ++count;
      used[vertex] = true;
    }
  return count;
}

std::vector<std::byte> encode_compressed_geometry(const CompressedGeometry& geometry, int bits) {
  assert(bits >= 1 && bits <= max_compressed_bits);
  const CompressedGeometry ordered = in_order_of_use(geometry);
  const Grid grid = grid_of(ordered.positions, bits);
  std::vector<glm::ivec3> cells;
  for (const glm::vec3& p : ordered.positions) {
    glm::ivec3 cell;
    for (int k = 0; k < 3; ++k)
      cell[k] = int(std::lround((double(p[k]) - double(grid.low[k])) / double(grid.step)));
    cells.push_back(cell);
  }
  RangeEncoder coder;
  GeometryWalk walk(coder, cells);
  for (const glm::uvec3& triangle : ordered.triangles) {
    glm::uvec3 same;
    walk.face(triangle, cells.size(), same);
    assert(same == triangle);
  }
  std::vector<std::byte> result(sizeof(Grid));
  std::memcpy(result.data(), &grid, sizeof(Grid));
  const std::vector<std::byte> stream = coder.finish();
  result.insert(result.end(), stream.begin(), stream.end());
  const std::size_t least = ordered.triangles.size() / max_faces_per_byte + 1;
  if (result.size() < least) result.resize(least);
  return result;
}

CompressedGeometry decode_compressed_geometry(std::span<const std::byte> bytes,
                                              std::size_t vertices, std::size_t faces,
                                              const std::string& file, MemoryBudget budget) {
  const auto damaged = [&]() -> InputError {
    return InputError({file}, "the compressed geometry is cut short or damaged");
  };
  if (bytes.size() < sizeof(Grid) || faces / max_faces_per_byte > bytes.size() ||
      vertices > 3 * faces)
    throw damaged();
  if (!budget.take(faces, bytes_a_face))
    throw InputError({file}, budget.refusal("the compressed geometry"), max_memory_hint);
  Grid grid;
  std::memcpy(&grid, bytes.data(), sizeof(Grid));
  for (int k = 0; k < 3; ++k)
    if (!std::isfinite(grid.low[k])) throw damaged();
  if (!std::isfinite(grid.step)) throw damaged();

  RangeDecoder coder(bytes.subspan(sizeof(Grid)));
  GeometryWalk walk(coder, std::span<const glm::ivec3>());
  CompressedGeometry result;
  for (std::size_t t = 0; t < faces; ++t) {
    glm::uvec3 triangle;
    // A decoder ignores the vertex; 0xffffffff is never a valid one.
    if (!walk.face(glm::uvec3(0xffffffffu), vertices, triangle)) throw damaged();
    result.triangles.push_back(triangle);
  }
  if (walk.cells.size() != vertices || coder.exhausted()) throw damaged();
  for (const glm::ivec3& cell : walk.cells) {
    glm::vec3 position;
    for (int k = 0; k < 3; ++k) {
      constexpr double most = double(std::numeric_limits<float>::max());
      const double exact = double(grid.low[k]) + double(cell[k]) * double(grid.step);
      position[k] = float(std::clamp(exact, -most, most));
    }
    result.positions.push_back(position);
  }
  return result;
}

}  // namespace tureen
