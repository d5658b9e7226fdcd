#include "tests/fuzz/folder_files.hpp"

#include <algorithm>
#include <utility>

#include "base/input.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "image/png.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/formats/splat/sog_fixture.hpp"

namespace tureen::fuzz {

namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// A network of 11-16-16-3, as in the published pages.
std::string network_json() {
  std::string text = "{\"obj_num\": 1";
  const int widths[] = {11, 16, 16, 3};
  const auto numbers = [&](int count) {
    std::string list = "[";
    for (int i = 0; i < count; ++i) list += (i ? "," : "") + std::to_string(i % 7);
    return list + "]";
  };
  for (int l = 0; l < 3; ++l) {
    text += ",\n\"" + std::to_string(l) + "_weights\": [";
    for (int i = 0; i < widths[l]; ++i) text += (i ? "," : "") + numbers(widths[l + 1]);
    text += "], \"" + std::to_string(l) + "_bias\": " + numbers(widths[l + 1]);
  }
  return text + "}";
}

}  // namespace

FolderFiles diffsoup_files() {
  test::RandomScene random(5);
  TriangleSoup soup = random.geometry(2, false);
  LatticeTexture texture = random.lattice_texture(2, 1, false);
  texture.mlp = random.diffsoup_mlp();
  // Equal weights keep the file short, because tests try every length.
  for (DenseLayer& layer : texture.mlp->layers)
    std::fill(layer.weights.begin(), layer.weights.end(), 0.5f);
  soup.appearance = std::move(texture);
  const Scene scene = scene_of(std::move(soup));
  const Scratch scratch("diffsoup_files");
  write_diffsoup_export(scene, scratch.folder() / "export");
  FolderFiles files;
  for (const auto& entry : std::filesystem::directory_iterator(scratch.folder() / "export"))
    files.emplace_back(entry.path().filename().string(), Input::open(entry.path()).read_rest());
  // Folders have no order, but the first byte of an input must always select the same file.
  std::sort(files.begin(), files.end());
  return files;
}

FolderFiles mobilenerf_files() {
  const auto features = encode_png(Image8(4, 4, glm::u8vec4(200, 100, 50, 255)));
  return {{"mlp.json", bytes_of(network_json())},
          {"shape0.obj", bytes_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0.75\nvt 1 0.75\n"
                                  "vt 1 0\nvt 0.25 0\nf 1/1 2/2 3/3 4/4\n")},
          {"shape0.pngfeat0.png", features},
          {"shape0.pngfeat1.png", features}};
}

FolderFiles sog_files() {
  FolderFiles files;
  for (const auto& [name, content] : test::streamed_splats())
    files.emplace_back(name, bytes_of(content));
  return files;
}

ScratchFiles::ScratchFiles(const std::string& name, FolderFiles valid)
    : scratch_(name), valid_(std::move(valid)) {
  for (const auto& [file, bytes] : valid_) scratch_.write(file, bytes);
}

void ScratchFiles::replace(std::size_t index, Bytes bytes) {
  index %= valid_.size();
  if (index != replaced_) scratch_.write(valid_[replaced_].first, valid_[replaced_].second);
  scratch_.write(valid_[index].first, bytes);
  replaced_ = index;
}

}  // namespace tureen::fuzz
