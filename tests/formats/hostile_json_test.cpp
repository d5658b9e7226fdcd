// Hostile JSON for every reader of JSON: nested, very long, with numbers out of range and lists of
// wrong lengths.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/json/json_file.hpp"
#include "base/json/json_view.hpp"
#include "formats/scene_file.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/hostile_bounds.hpp"
#include "tests/fuzz/fixtures.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace hostile_json_test {

using test::ErrorIn;
using test::Names;
namespace fs = std::filesystem;
using test::Bytes;
using test::bytes_of;
using test::error_of;
using test::TemporaryFolder;
using test::text_of;
using test::within_bounds;
using ::testing::AnyOf;

struct JsonReader {
  const char* name;
  void (*read)(const std::string& text, const fs::path& folder);
};

void read_in_folder(const fs::path& folder, const fuzz::FolderFiles& files, const char* name,
                    const std::string& text) {
  for (const auto& [file, bytes] : files) test::write_bytes(folder / file, bytes);
  test::write_text(folder / name, text);
  read_scene(folder);
}

/// A GLB with this JSON and nothing else.
Bytes glb_of(const std::string& text) {
  std::string padded = text;
  padded.append((4 - padded.size() % 4) % 4, ' ');
  const std::uint32_t head[] = {0x46546C67, 2, std::uint32_t(20 + padded.size()),
                                std::uint32_t(padded.size()), 0x4E4F534A};
  Bytes bytes(sizeof head + padded.size());
  std::memcpy(bytes.data(), head, sizeof head);
  std::memcpy(bytes.data() + sizeof head, padded.data(), padded.size());
  return bytes;
}

/// A training checkpoint with this configuration.
Bytes checkpoint_of(const std::string& text) {
  const std::vector<fuzz::Fixture>& fixtures = fuzz::fixtures();
  const auto whole =
      std::find_if(fixtures.begin(), fixtures.end(),
                   [](const fuzz::Fixture& fixture) { return fixture.name == "run.checkpoint"; });
  constexpr std::size_t head = 8 + 4;  // the magic and the version
  std::uint64_t size = 0;
  std::memcpy(&size, &whole->bytes[head], sizeof size);
  const auto behind = whole->bytes.begin() + std::ptrdiff_t(head + sizeof size + size);
  Bytes bytes(whole->bytes.begin(), whole->bytes.begin() + head + sizeof size);
  size = text.size();
  std::memcpy(&bytes[head], &size, sizeof size);
  const Bytes configuration = bytes_of(text);
  bytes.insert(bytes.end(), configuration.begin(), configuration.end());
  bytes.insert(bytes.end(), behind, whole->bytes.end());
  return bytes;
}

const std::array<JsonReader, 17> json_readers{{
    {"cameras", [](const std::string& text, const fs::path&) { fuzz::cameras(bytes_of(text)); }},
    {"path", [](const std::string& text, const fs::path&) { fuzz::camera_path(bytes_of(text)); }},
    {"session", [](const std::string& text, const fs::path&) { fuzz::session(bytes_of(text)); }},
    {"settings", [](const std::string& text, const fs::path&) { fuzz::settings(bytes_of(text)); }},
    {"transforms",
     [](const std::string& text, const fs::path&) { fuzz::transforms(bytes_of(text)); }},
    {"bench.json",
     [](const std::string& text, const fs::path&) { fuzz::bench_result(bytes_of(text)); }},
    {"bench of a page",
     [](const std::string& text, const fs::path&) { fuzz::web_bench(bytes_of(text)); }},
    {"checkpoint", [](const std::string& text,
                      const fs::path&) { fuzz::training_checkpoint(checkpoint_of(text)); }},
    {"configuration",
     [](const std::string& text, const fs::path&) { fuzz::training_config(bytes_of(text)); }},
    {"log of a run",
     [](const std::string& text, const fs::path&) { fuzz::training_log(bytes_of(text + "\n")); }},
    {"gltf", [](const std::string& text, const fs::path&) { fuzz::gltf(bytes_of(text)); }},
    {"glb", [](const std::string& text, const fs::path&) { fuzz::gltf(glb_of(text)); }},
    {"preview", [](const std::string& text, const fs::path&) { fuzz::preview(glb_of(text)); }},
    {"meta.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::diffsoup_files(), "meta.json", text);
     }},
    {"mlp_weights.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::diffsoup_files(), "mlp_weights.json", text);
     }},
    {"mlp.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::mobilenerf_files(), "mlp.json", text);
     }},
    {"small files",
     [](const std::string& text, const fs::path&) {
       Input input = test::input_of(text, "a.json");
       read_json(input, RepeatedKeys::refused);
     }},
}};

/// {"asset": {"version": "2.0"}, "extras": [[[..]]]}, which every reader accepts as its format.
std::string nested(int depth, char open, char close) {
  std::string text = R"({"asset": {"version": "2.0"}, "extras": )";
  for (int i = 0; i < depth; ++i)
    text += open == '{' ? std::string("{\"a\":") : std::string(1, open);
  text += "1" + std::string(std::size_t(depth), close) + "}";
  return text;
}

TEST(HostileJson, WhatNoDoubleHoldsIsNullWhereAsked) {
  const auto read = [](const std::string& text) {
    Input input = test::input_of(text, "a.json");
    return read_json(input, RepeatedKeys::last_counts, NonFinite::null).dump();
  };
  EXPECT_EQ(read(R"([NaN, nan, -NaN, Infinity, -Infinity, inf, 1e999, -1E+400, 1e-999, 3])"),
            "[null,null,null,null,null,null,null,null,0.0,3]");
  EXPECT_EQ(read(R"({"NaN \\": "\\\" NaN", "x": [true, false, null, -1.5e3]})"),
            R"({"NaN \\":"\\\" NaN","x":[true,false,null,-1500.0]})");
  for (const char* wrong : {"[NaNs]", "[in]", "[\"NaN", "[NaN", "nope"})
    EXPECT_THROW(read(wrong), InputError) << wrong;
}

TEST(HostileJson, NestedDeeperThanOurLimitIsRefusedEverywhere) {
  for (const std::pair<char, char>& ends : {std::pair('[', ']'), std::pair('{', '}')})
    for (const int depth : {63, 64, 65, 1000, 1000000}) {
      const std::string text = nested(depth, ends.first, ends.second);
      for (const JsonReader& reader : json_readers) {
        const TemporaryFolder folder;
        SCOPED_TRACE(reader.name + std::string(" at depth ") + std::to_string(depth));
        within_bounds(
            default_max_memory,
            [&] {
              const auto error = error_of([&] { reader.read(text, folder / ""); });
              if (depth > 63) {
                EXPECT_THAT(error, Names(64));
              } else {  // the error is another one
                EXPECT_THAT(error, ::testing::Not(Names(64)));
              }
            },
            "depth");
      }
    }
}

TEST(HostileJson, OfMoreValuesThanMemoryIsRefusedBeforeItIsParsed) {
  std::string text = R"({"asset": {"version": "2.0"}, "materials": [)";
  for (int i = 0; i < 1000000; ++i) text += i ? ",{}" : "{}";
  text += "]}";
  within_bounds(
      64 << 20, [&] { EXPECT_THAT(error_of([&] { fuzz::gltf(bytes_of(text)); }), Names(64)); },
      "materials");
}

TEST(HostileJson, NamesOfMembersMayBeAnythingAtAnyLength) {
  const std::string head = R"({"asset": {"version": "2.0"}, "nodes": [{")";
  const auto read = [&](const std::string& name, const std::string& value) {
    return error_of([&] { fuzz::gltf(bytes_of(head + name + "\": " + value + "}]}")); });
  };
  // The character U+0000 ends names in C.
  EXPECT_THAT(read("a\\u0000b", "[4294967296]"), ::testing::Not(Names(2147483647)));
  const auto named = error_of([&] {
    fuzz::gltf(bytes_of(R"({"asset": {"version": "2.0\u0000\n", "minVersion": "a\u0000b\nc"}})"));
  });
  EXPECT_THAT(named, Names("a\\u0000b\\nc", "2.0"));
  EXPECT_THAT(read("mesh", "4294967296"), Names("nodes[0].mesh", "2147483647"));
  EXPECT_THAT(read("mesh", "-4294967295"), Names("nodes[0].mesh", "2147483647"));
  EXPECT_THAT(read("children", "[0, 4294967296]"), Names("nodes[0].children[1]", "2147483647"));
  // A long name above many values: composing a path for each value would take terabytes.
  std::string many = "[0";
  for (int i = 0; i < 500000; ++i) many += ",0";
  within_bounds(
      default_max_memory, [&] { read(std::string(1 << 20, 'a'), many + "]"); }, "long name");
}

// Row X2 of the catalogue of numerical hazards: numbers outside the range of double, and lists of
// wrong lengths.
TEST(HostileJson, X2_NumbersThatNoDoubleHoldsAreRefused) {
  for (const char* number : {"1e999", "-1e999"}) {
    const std::string text =
        R"({"asset": {"version": "2.0"}, "frames": [)" + std::string(number) + "]}";
    EXPECT_THAT(error_of([&] { parse_json(text, "a.json"); }), ErrorIn("a.json", number));
    for (const JsonReader& reader : json_readers) {
      const TemporaryFolder folder;
      const auto error = error_of([&] { reader.read(text, folder / ""); });
      // In a dataset, the number costs its frame: it is null.
      if (reader.name == std::string("transforms"))
        EXPECT_THAT(error, Names("frame 0"));
      else
        EXPECT_THAT(error, Names(number)) << reader.name;
    }
  }
}

/// Finds lists of at most 16 numbers, which have a fixed length: a vector, a matrix, the biases of
/// a layer. The nodes of a glTF scene may have any length.
void find_lists(const nlohmann::json& json, const nlohmann::json::json_pointer& at,
                std::vector<nlohmann::json::json_pointer>& found) {
  const bool is_list = json.is_array() && !json.empty() && json.size() <= 16 &&
                       std::all_of(json.begin(), json.end(),
                                   [](const nlohmann::json& value) { return value.is_number(); });
  if (is_list && at.back() != "nodes") found.push_back(at);
  for (const auto& [key, value] : json.items())
    if (value.is_structured())
      find_lists(value, json.is_array() ? at / std::size_t(std::stoul(key)) : at / key, found);
}

/// The name of the member that contains the list.
std::string named(nlohmann::json::json_pointer list) {
  const auto is_digit = [](unsigned char letter) { return std::isdigit(letter) != 0; };
  while (std::all_of(list.back().begin(), list.back().end(), is_digit)) list.pop_back();
  return list.back();
}

TEST(HostileJson, X2_ListsOfWrongLengthsAreRefused) {
  const auto file_of = [](const fuzz::FolderFiles& files, const char* name) {
    for (const auto& [file, bytes] : files)
      if (file == name) return text_of(bytes);
    ADD_FAILURE() << "no " << name;
    return std::string();
  };
  std::vector<std::pair<std::string, std::string>> documents;  // name and input of a reader
  const std::map<std::string, std::string> readers{{"cameras", "cameras"},
                                                   {"camera_path", "path"},
                                                   {"session", "session"},
                                                   {"settings", "settings"},
                                                   {"transforms", "transforms"},
                                                   {"web_bench", "bench of a page"},
                                                   {"training_config", "configuration"}};
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (const auto reader = readers.find(fixture.target); reader != readers.end())
      documents.emplace_back(reader->second, text_of(fixture.bytes));
    if (fixture.name == "foreign.gltf") documents.emplace_back("gltf", text_of(fixture.bytes));
  }
  for (const char* name : {"meta.json", "mlp_weights.json"})
    documents.emplace_back(name, file_of(fuzz::diffsoup_files(), name));
  documents.emplace_back("mlp.json", file_of(fuzz::mobilenerf_files(), "mlp.json"));
  std::map<std::string, std::size_t> refused;
  for (const auto& [name, text] : documents) {
    const auto reader = std::find_if(
        json_readers.begin(), json_readers.end(),
        [&name = name](const JsonReader& candidate) { return candidate.name == name; });
    ASSERT_NE(reader, json_readers.end()) << name;
    const auto whole = nlohmann::json::parse(text);
    std::vector<nlohmann::json::json_pointer> lists;
    find_lists(whole, nlohmann::json::json_pointer(), lists);
    for (const auto& list : lists)
      for (const int change : {-1, 1}) {
        nlohmann::json changed = whole;
        if (change < 0)
          changed[list].erase(changed[list].size() - 1);
        else
          changed[list].push_back(changed[list].front());
        const TemporaryFolder folder;
        const auto error = error_of([&] { reader->read(changed.dump(), folder / ""); });
        refused[name] += error.has_value();
        // If one view has another number of times, the error names the next view.
        EXPECT_THAT(error, AnyOf(Names(named(list)), Names("self_test_ms[1][0]", 3)))
            << name << list.to_string() << (change < 0 ? " shorter" : " longer");
      }
  }
  for (const auto& [name, text] : documents) EXPECT_GT(refused[name], 0u) << name;
}

}  // namespace hostile_json_test
}  // namespace tureen
