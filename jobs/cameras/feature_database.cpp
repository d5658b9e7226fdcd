#include "jobs/cameras/feature_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "base/error.hpp"

namespace tureen {

namespace {

/// A statement, stepped through its rows.
class Rows {
 public:
  Rows(sqlite3* database, const std::string& file, const char* query)
      : database_(database), file_(file) {
    if (sqlite3_prepare_v2(database, query, -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  ~Rows() { sqlite3_finalize(statement_); }

  void bind(std::int64_t value) { sqlite3_bind_int64(statement_, 1, value); }
  bool next() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail();
    return result == SQLITE_ROW;
  }
  std::int64_t number(int column) { return sqlite3_column_int64(statement_, column); }
  std::span<const std::byte> bytes(int column) {
    const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement_, column));
    return {data, data ? std::size_t(sqlite3_column_bytes(statement_, column)) : 0};
  }
  std::string text(int column) {
    const std::span<const std::byte> found = bytes(column);
    return {reinterpret_cast<const char*>(found.data()), found.size()};
  }

 private:
  [[noreturn]] void fail() {
    throw InputError({file_},
                     std::string("COLMAP's database cannot be read: ") + sqlite3_errmsg(database_));
  }
  sqlite3* database_;
  const std::string& file_;
  sqlite3_stmt* statement_ = nullptr;
};

// COLMAP's number of a pair is first * factor + second.
constexpr std::int64_t pair_factor = 2147483647;

// COLMAP's configurations of a pair: planar, panoramic, or one of both.
constexpr std::int64_t first_flat = 4, last_flat = 6;

}  // namespace

void FeatureDatabase::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

FeatureDatabase::FeatureDatabase(const std::filesystem::path& file) : file_(file.string()) {
  sqlite3* opened = nullptr;
  // Not read-only: a killed COLMAP leaves a journal, which opening merges into the file.
  const int result = sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
  database_.reset(opened);
  if (result != SQLITE_OK)
    throw InputError({file_}, std::string("COLMAP's database cannot be opened: ") +
                                  (opened ? sqlite3_errmsg(opened) : "out of memory"));
}

std::vector<FeatureDatabase::Photo> FeatureDatabase::photos() const {
  std::vector<Photo> photos;
  Rows rows(database_.get(), file_,
            "SELECT i.image_id, i.camera_id, IFNULL(k.rows, 0), i.name FROM images i LEFT JOIN "
            "keypoints k ON k.image_id = i.image_id ORDER BY i.image_id");
  while (rows.next())
    photos.push_back({.number = std::uint32_t(rows.number(0)),
                      .camera = std::uint32_t(rows.number(1)),
                      .features = std::uint64_t(rows.number(2)),
                      .name = rows.text(3)});
  return photos;
}

std::vector<FeatureDescriptor> FeatureDatabase::descriptors(std::uint32_t photo,
                                                            std::size_t most) const {
  std::vector<FeatureDescriptor> chosen;
  Rows rows(database_.get(), file_, "SELECT data FROM descriptors WHERE image_id = ?");
  rows.bind(photo);
  if (!rows.next()) return chosen;
  const std::span<const std::byte> bytes = rows.bytes(0);
  const std::size_t all = bytes.size() / sizeof(FeatureDescriptor);
  chosen.resize(std::min(all, most));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    std::memcpy(chosen[i].data(),
                bytes.data() + i * all / chosen.size() * sizeof(FeatureDescriptor),
                sizeof(FeatureDescriptor));
  return chosen;
}

std::vector<FeatureDatabase::Pair> FeatureDatabase::pairs() const {
  std::vector<Pair> pairs;
  Rows rows(database_.get(), file_,
            "SELECT pair_id, rows, config, H FROM two_view_geometries WHERE rows > 0 "
            "ORDER BY pair_id");
  while (rows.next()) {
    Pair& pair = pairs.emplace_back();
    pair.first = std::uint32_t(rows.number(0) / pair_factor);
    pair.second = std::uint32_t(rows.number(0) % pair_factor);
    pair.matches = std::uint64_t(rows.number(1));
    pair.is_flat = rows.number(2) >= first_flat && rows.number(2) <= last_flat;
    std::array<double, 9> values{};  // row by row
    if (const auto bytes = rows.bytes(3); bytes.size() == sizeof values)
      std::memcpy(values.data(), bytes.data(), sizeof values);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        pair.second_from_first[column][row] = values[std::size_t(3 * row + column)];
  }
  return pairs;
}

}  // namespace tureen
