#include "tests/support/measured.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <utility>

namespace tureen::test {

void leave_measured(const std::string& table, nlohmann::json row) {
  const char* path = std::getenv("TUREEN_MEASURED");
  if (!path) return;
  row["table"] = table;
  std::ofstream file(path, std::ios::app);
  file << row.dump() << "\n";
  file.close();
  EXPECT_TRUE(file) << path << " cannot be written";
}

}  // namespace tureen::test
