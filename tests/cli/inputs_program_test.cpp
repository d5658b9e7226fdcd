// Inputs that are not files, or that may not be read: the error names the kind, and the program
// does not wait.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/cli/nobody.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace inputs_program_test {

using test::Names;
namespace fs = std::filesystem;
using test::ChildResult;
using test::Nobody;
using testing::StartsWith;

class Inputs : public test::Program {
 protected:
  void expect(const std::vector<std::string>& arguments, const std::string& file,
              const std::string& value = "") const {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 3) << arguments[0];
    EXPECT_THAT(result.err, AllOf(StartsWith("tureen: " + file + ": "), Names(value)))
        << arguments[0];
  }
  /// Every command that reads, with `file` as its input.
  std::vector<std::vector<std::string>> readers(const std::string& file) const {
    return {{"info", file},
            {"render", file},
            {"convert", file, "out.glb"},
            {"bench", file},
            {"compare", file, file},
            {"eval", "scene.off", file},
            {"train", file, "-o", "out.glb"},
            {"train", "photographs", "-o", "out.glb", "--config", file},
            {"render", "scene.off", "--camera", file},
            {"render", "scene.off", "--path", file, "-o", "f_%d.png"},
            {"bench", "scene.off", "--against", file}};
  }
};

TEST_F(Inputs, ThatMayNotBeReadAreNotToldAsMissing) {
  write_scene();
  fs::create_directory(folder / "locked");
  fs::copy(folder / "scene.off", folder / "locked/scene.off");
  fs::copy(folder / "scene.off", folder / "secret.off");
  fs::permissions(folder, fs::perms::all);
  fs::permissions(folder / "scene.off", fs::perms(0644));
  fs::permissions(folder / "secret.off", fs::perms::none);
  test::make_streams_for_all(folder);
  fs::permissions(folder / "locked", fs::perms::none);
  bool may_run = true;
  {
    const Nobody nobody;
    if (::eaccess(TUREEN_PROGRAM, X_OK) != 0) {
      may_run = false;
    } else {
      for (const auto& arguments : readers("locked/scene.off"))
        expect(arguments, "locked/scene.off", "Permission denied");
      for (const auto& arguments : readers("secret.off"))
        expect(arguments, "secret.off", "Permission denied");
      for (const char* command : {"info", "render"})
        expect({command, "locked"}, "locked", "Permission denied");
      expect({"eval", "scene.off", "locked"}, "locked", "Permission denied");
    }
  }
  fs::permissions(folder / "locked", fs::perms::owner_all);
  if (!may_run) GTEST_SKIP() << TUREEN_PROGRAM << " is not executable for every user";
}

TEST_F(Inputs, ThatAreNoFilesAreRefusedAtOnce) {
  write_scene();
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0644), 0);
  // No process writes into the pipe: a program that opened it would wait forever.
  for (const char* file : {"pipe", "/dev/zero"})
    for (const auto& arguments : readers(file)) expect(arguments, file);
}

TEST_F(Inputs, ThatAreFoldersWhereFilesAreExpectedAreToldSo) {
  write_scene();
  fs::create_directory(folder / "folder");
  expect({"compare", "folder", "folder"}, "folder");
  expect({"render", "scene.off", "--path", "folder", "-o", "f_%d.png"}, "folder");
  expect({"info", "folder"}, "folder");
}

TEST_F(Inputs, ThatAreLinksToNothingAreToldSo) {
  fs::create_symlink("gone.off", folder / "link.off");
  expect({"info", "link.off"}, "link.off", "gone.off");
}

}  // namespace inputs_program_test
}  // namespace tureen
