// Where outputs go: through links, and never over special or protected files. Errors come before
// anything is read.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "tests/cli/nobody.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace outputs_program_test {

using test::Names;
namespace fs = std::filesystem;
using test::ChildResult;
using test::Nobody;

class Outputs : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write_scene();
    // No command reads it: each fails earlier.
    write("bad.off", "COFF\nnonsense\n");
    write_png("a.png", Image8(8, 8));
    write("log.jsonl", "");
  }
  void expect(const std::vector<std::string>& arguments, int exit_code,
              const auto&... values) const {
    SCOPED_TRACE(arguments[0] + " " + arguments.back());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.err, Names(values...));
  }
  std::size_t triangles(const std::string& file) const {
    return only_soup(read_scene(folder / file)).triangles.size();
  }
};

TEST_F(Outputs, GoWhereLinksLeadAndTheLinksStay) {
  fs::create_directory(folder / "far");
  const auto is_link = [&](const char* name) { return fs::is_symlink(folder / name); };
  fs::create_symlink("far/new.ply", folder / "new.ply");  // its target does not exist yet
  EXPECT_EQ(run({"convert", "scene.off", "new.ply"}).exit_code, 0);
  EXPECT_TRUE(is_link("new.ply"));
  EXPECT_EQ(triangles("far/new.ply"), 3u);

  write("far/old.ply", "precious");
  fs::create_symlink("far/old.ply", folder / "middle");
  fs::create_symlink("middle", folder / "old.ply");
  expect({"convert", "scene.off", "old.ply"}, 2, "old.ply", "--force");
  EXPECT_EQ(fs::file_size(folder / "far/old.ply"), 8u);
  EXPECT_EQ(run({"convert", "scene.off", "old.ply", "--force"}).exit_code, 0);
  EXPECT_TRUE(is_link("old.ply"));
  EXPECT_TRUE(is_link("middle"));
  EXPECT_EQ(triangles("far/old.ply"), 3u);

  fs::create_symlink("ring.ply", folder / "ring.ply");
  expect({"convert", "scene.off", "ring.ply"}, 5, "Too many levels of symbolic links", "ring.ply");
}

TEST_F(Outputs, ThatAreFoldersGoWhereLinksLead) {
  write("other.off", "OFF\n3 1 0\n0 0 0\n7 0 0\n0 7 0\n3 0 1 2\n");
  ASSERT_EQ(run({"convert", "scene.off", "real/"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "other.off", "expected/"}).exit_code, 0);
  fs::create_symlink("real", folder / "export");
  EXPECT_EQ(run({"convert", "other.off", "export", "--force"}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "export"));
  EXPECT_EQ(Input::open(folder / "real/mesh.ply").read_rest(),
            Input::open(folder / "expected/mesh.ply").read_rest());
}

TEST_F(Outputs, ThatAreFoldersDoNotTakeAnythingElseWithThem) {
  ASSERT_EQ(run({"convert", "scene.off", "export/"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "scene.off", "export/", "--force"}).exit_code, 0);
  write("export/notes.txt", "precious");
  expect({"convert", "scene.off", "export/", "--force"}, 2, "notes.txt");
  EXPECT_EQ(fs::file_size(folder / "export/notes.txt"), 8u);
}

TEST_F(Outputs, AreNotTheInputs) {
  write_png("b.png", Image8(8, 8));
  const auto before = Input::open(folder / "a.png").read_rest();
  fs::create_symlink("a.png", folder / "link.png");
  for (const char* diff : {"a.png", "./a.png", "link.png"})
    expect({"compare", "a.png", "b.png", "--diff", diff}, 2, diff);
  EXPECT_EQ(Input::open(folder / "a.png").read_rest(), before);
  const auto bench = [&](std::vector<std::string> outputs, const char* name) {
    outputs.insert(outputs.begin(), {"bench", "scene.off"});
    expect(outputs, 2, name);
  };
  write("bench.json", "{}");
  bench({"--against", "bench.json", "-o", "."}, "bench.json");
  bench({"--cameras", "bench.json", "-o", "."}, "bench.json");
  fs::create_directory(folder / "photographs");
  write("photographs/bench.json", "{}");
  bench({"photographs", "-o", "photographs"}, "photographs");
}

TEST_F(Outputs, ReplaceNothingInFoldersOfInputs) {
  ASSERT_EQ(run({"convert", "scene.off", "export/"}).exit_code, 0);
  const auto before = Input::open(folder / "export/mesh.ply").read_rest();
  fs::create_symlink("export/mesh.ply", folder / "link.ply");
  for (const char* output : {"export/mesh.ply", "export/../export/mesh.ply", "link.ply"})
    expect({"convert", "export", output, "--force"}, 2, "export");
  expect({"render", "export", "-o", "export/lut0.png"}, 2, "export/lut0.png");
  expect({"render", "export", "--orbit", "2", "-o", "export/lut%d.png"}, 2, "lut0.png");
  // Replacing a whole folder would remove the input in it.
  expect({"convert", "export/mesh.ply", "export", "--force"}, 2, "export/mesh.ply");
  EXPECT_EQ(Input::open(folder / "export/mesh.ply").read_rest(), before);
  // A new file may be created in the folder, but not replaced.
  EXPECT_EQ(run({"convert", "export", "export/scene.glb"}).exit_code, 0);
  expect({"convert", "export", "export/scene.glb", "--force"}, 2, "scene.glb");
}

TEST_F(Outputs, KeepThePermissionsOfWhatTheyReplace) {
  write("private.ply", "old");
  fs::permissions(folder / "private.ply", fs::perms(0600));
  ASSERT_EQ(run({"convert", "scene.off", "private.ply", "--force"}).exit_code, 0);
  EXPECT_EQ(fs::status(folder / "private.ply").permissions(), fs::perms(0600));
}

TEST_F(Outputs, InFoldersDoNotDependOnWhatElseIsThere) {
  write_scene();
  // As in a folder with a checkout of this project.
  fs::create_directory(folder / "tureen");
  EXPECT_EQ(run({"convert", "scene.off", "export/"}).exit_code, 0);
  fs::create_symlink("nowhere", folder / "views");
  expect({"eval", "bad.off", "photographs", "-o", "views"}, 5, "views");
}

TEST_F(Outputs, AreNoPipesNorDevices) {
  ASSERT_EQ(::mkfifo((folder / "pipe.ply").c_str(), 0644), 0);
  fs::create_symlink("/dev/null", folder / "null.ply");
  for (const char* output : {"pipe.ply", "null.ply"}) {
    expect({"convert", "bad.off", output}, 5, output);
    expect({"convert", "bad.off", output, "--force"}, 5, output);
  }
  ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0644), 0);
  expect({"render", "bad.off", "-o", "pipe.png"}, 5, "pipe.png");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe.ply"));
}

TEST_F(Outputs, DoNotReplaceWhatIsWriteProtected) {
  write("precious.ply", "precious");
  write_scene();
  ASSERT_EQ(run({"convert", "scene.off", "export/"}).exit_code, 0);
  // The folder of the link's target counts, not the folder of the link.
  fs::create_directory(folder / "locked");
  fs::create_symlink("locked/export", folder / "link");
  fs::permissions(folder / "locked", fs::perms(0555));
  fs::permissions(folder / "export", fs::perms(0555));
  fs::permissions(folder, fs::perms::all);
  fs::permissions(folder / "precious.ply", fs::perms(0444));
  test::make_streams_for_all(folder);
  const Nobody nobody;
  if (::eaccess(TUREEN_PROGRAM, X_OK) != 0)
    GTEST_SKIP() << TUREEN_PROGRAM << " is not executable for every user";
  expect({"convert", "bad.off", "precious.ply", "--force"}, 5, "precious.ply");
  expect({"convert", "bad.off", "export/", "--force"}, 5, "export");
  expect({"convert", "bad.off", "link"}, 5, "Permission denied");
  EXPECT_EQ(fs::file_size(folder / "precious.ply"), 8u);
}

TEST_F(Outputs, ThatCannotBeWrittenAreToldBeforeAnythingIsRead) {
  fs::create_directory(folder / "folder.ply");
  write("file", "");
  expect({"convert", "bad.off", "nowhere/out.ply"}, 5, "nowhere/out.ply");
  expect({"convert", "bad.off", "nowhere/export/"}, 5, "nowhere");
  expect({"convert", "bad.off", "folder.ply", "--force"}, 5, "folder.ply");
  // --force would change nothing here, so the error does not mention it.
  expect({"convert", "bad.off", "folder.ply"}, 5, "folder.ply");
  expect({"convert", "bad.off", "file"}, 2, "file");
  expect({"convert", "bad.off", "file", "--force"}, 2, "file");
  expect({"convert", "bad.off", "out.xyz"}, 2, ".xyz");
  expect({"convert", "bad.off", "out.xyz"}, 2, ".html");
  expect({"convert", "bad.off", "out.gltf"}, 2, ".glb");
  expect({"convert", "bad.off", "."}, 2, "bad.off");
  for (const char* name : {".ply", ".gltf", ".html"}) expect({"convert", "bad.off", name}, 2, name);
  expect({"convert", "bad.off", ".hidden"}, 3, "bad.off");  // a folder name
  expect({"render", "bad.off", "-o", "nowhere/out.png"}, 5, "nowhere");
  expect({"render", "bad.off", "--orbit", "3", "-o", "nowhere/o.png"}, 5, "nowhere");
  expect({"render", "bad.off", "--turntable", "1", "-o", "nowhere/o.png"}, 5, "nowhere");
  expect({"compare", "bad.png", "a.png", "--diff", "nowhere/d.png"}, 5, "nowhere");
  expect({"eval", "bad.off", "photographs", "-o", "file/views"}, 5, "file/views");
  expect({"bench", "bad.off", "-o", "file/b"}, 5, "file/b");
  expect({"tradeoff", "bad.off", "-o", "file/t"}, 5, "file/t");
  expect({"tradeoff", "bad.off", "--write", "nowhere/t.glb"}, 5, "nowhere");
}

TEST_F(Outputs, ProbesLeaveNothing) {
  const auto count = [&] {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  };
  run({"convert", "bad.off", "out.glb"});
  const auto before = count();  // with the streams
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"convert", "bad.off", "export/"},
                                             {"render", "bad.off"},
                                             {"eval", "bad.off", "photographs", "-o", "views"},
                                             {"compare", "bad.png", "a.png", "--diff", "d.png"}})
    EXPECT_EQ(run(arguments).exit_code, 3) << arguments[0];
  EXPECT_EQ(count(), before);
}

TEST_F(Outputs, AndInputsHaveNames) {
  expect({"convert", "", "out.glb"}, 2, "IN");
  expect({"convert", "scene.off", ""}, 2, "OUT");
  expect({"info", ""}, 2, "SCENE");
  expect({"render", "scene.off", "-o", ""}, 2, "--output");
  expect({"compare", "a.png", "a.png", "--diff", ""}, 2, "--diff");
  expect({"eval", "scene.off", ""}, 2, "DATASET");
}

TEST_F(Outputs, OfRenderReplaceNothingWithoutForce) {
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "scene.off", "--context", "osmesa", "--size", "16x12"});
    return test::run_tureen(more, folder);
  };
  const ChildResult first = render({"-o", "first.png", "--background", "#ff8000", "--up", "-y"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, testing::AllOf(Names("first.png", "16 x 12"),
                                        testing::Not(testing::HasSubstr("Plan:"))));
  EXPECT_EQ(read_png("first.png").at(0, 0), glm::u8vec4(255, 128, 0, 255));
  const auto refused = [&](const std::vector<std::string>& more, const char* file) {
    const ChildResult result = render(more);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, Names(file, "exists", "--force"));
  };
  refused({"-o", "first.png"}, "first.png");
  EXPECT_EQ(render({"-o", "first.png", "--force", "--background", "navy"}).exit_code, 0);
  EXPECT_EQ(read_png("first.png").at(0, 0), glm::u8vec4(0, 0, 128, 255));
  // Images of an orbit, also later ones, and the sheet.
  write("turn_2.png", "photograph");
  refused({"--orbit", "3", "-o", "turn_%d.png"}, "turn_2.png");
  EXPECT_FALSE(exists("turn_0.png"));
  ASSERT_EQ(render({"--orbit", "3", "-o", "round_%d.png"}).exit_code, 0);
  refused({"--orbit", "3", "-o", "circle_%d.png"}, "contact_sheet.png");
  refused({"-o", "b.png", "--depth", "turn_2.png"}, "turn_2.png");
  const ChildResult quiet = render({"-o", "b.png", "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(render({"-o", "b.png", "--quiet"}).exit_code, 2);
  EXPECT_NE(render({"-o", "b.png", "--quiet"}).err, "");
  EXPECT_THAT(render({"-o", "c.png", "--verbose"}).err, testing::HasSubstr("Plan:"));
  EXPECT_EQ(render({"-o", "d.png", "--background", "#ff80"}).exit_code, 2);
  EXPECT_EQ(render({"-o", "d.png", "--background", "redd"}).exit_code, 2);
  EXPECT_EQ(render({"-o", "d.png", "--up", "w"}).exit_code, 2);
}

}  // namespace outputs_program_test
}  // namespace tureen
