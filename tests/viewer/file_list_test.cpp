// The list in the file dialog.
#include "viewer/files/file_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace tureen::viewer {
namespace file_list_test {

namespace fs = std::filesystem;

TEST(FileList, HoldsFoldersFirstAndWhatCanBeShown) {
  const fs::path folder = fs::path(testing::TempDir()) / "file_list";
  fs::remove_all(folder);
  fs::create_directories(folder / "z folder");
  fs::create_directories(folder / ".hidden");
  for (const char* name : {"b.glb", "a.off", "notes.txt", "transforms.json", "c.ply"})
    std::ofstream(folder / name) << "x";
  std::vector<std::string> names;
  for (const FileEntry& entry : list_files(folder).entries)
    names.push_back(entry.path.filename().string());
  EXPECT_THAT(names,
              testing::ElementsAre("z folder", "a.off", "b.glb", "c.ply", "transforms.json"));
}

TEST(FileList, NoticesPhotographs) {
  const fs::path folder = fs::path(testing::TempDir()) / "photographs";
  fs::remove_all(folder);
  fs::create_directories(folder);
  EXPECT_FALSE(list_files(folder).has_photographs);
  std::ofstream(folder / "a.jpg") << "x";
  EXPECT_TRUE(list_files(folder).has_photographs);
  fs::remove_all(folder);
}

TEST(FileList, SaysWhatItCannotList) {
  const FileList list = list_files("/there/is/no/such/folder");
  EXPECT_TRUE(list.entries.empty());
  EXPECT_FALSE(list.trouble.empty());
}

TEST(FileList, TypedPathsBeginInTheFolder) {
  FileList list;
  list.folder = "/scenes/lego";
  const auto path_of = [&](const char* typed) {
    list.typed = typed;
    return typed_path(list);
  };
  EXPECT_EQ(path_of("soup.glb"), "/scenes/lego/soup.glb");
  EXPECT_EQ(path_of("../fox/"), "/scenes/fox");
  EXPECT_EQ(path_of("/other.glb"), "/other.glb");
}

}  // namespace file_list_test
}  // namespace tureen::viewer
