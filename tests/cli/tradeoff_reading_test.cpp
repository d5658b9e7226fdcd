// Results of `tureen tradeoff` read back: nothing is lost, and nothing that is missing, of another
// kind or impossible passes.
#include "cli/tradeoff_reading.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>

#include "cli/tradeoff_fixture.hpp"
#include "soup/error.hpp"

namespace tureen::cli {
namespace {

using nlohmann::json;
using test::lego;
using testing::HasSubstr;
using Pointer = json::json_pointer;

TradeoffReport read_text(const std::string& text) {
  Input input = Input::memory("lego.json", std::as_bytes(std::span(text)));
  return read_tradeoff(input);
}

/// The sentence in which reading ends, or "" where it does not end in one.
std::string refusal(const std::string& text) {
  try {
    read_text(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

json written(const TradeoffReport& report) { return json::parse(to_json(report).dump()); }

json with_photographs() {
  json document = lego();
  document["e_model"] = {
      {"dataset", "photos"}, {"split", "test"}, {"photographs", 4}, {"ssim_border", "valid"}};
  for (const char* panel : {"drawing", "antialiasing"})
    document[panel]["configurations"][0]["e_model"] = {
        {"psnr_db", 27.0}, {"ssim", 0.9}, {"flip", 0.1}};
  document["choice"]["written"] = "fast.glb";
  return document;
}

/// Where all values stand, objects and arrays included, but for the whole document.
void collect(const json& value, const Pointer& at, std::vector<Pointer>& pointers) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    const Pointer place = value.is_array() ? at / std::stoul(key) : at / key;
    pointers.push_back(place);
    collect(member, place, pointers);
  }
}

std::vector<Pointer> places(const json& document) {
  std::vector<Pointer> pointers;
  collect(document, Pointer(), pointers);
  return pointers;
}

TEST(TradeoffReading, LosesNothing) {
  EXPECT_EQ(written(read_text(lego().dump())), lego());
  EXPECT_EQ(written(read_text(with_photographs().dump())), with_photographs());
  json document = lego();
  document["choice"] = nullptr;
  document["r0"] = nullptr;
  document["a key of tomorrow"] = 1;
  json expected = document;
  expected.erase("a key of tomorrow");
  EXPECT_EQ(written(read_text(document.dump())), expected);
}

TEST(TradeoffReading, WithoutFlipThereIsNoneAnywhere) {
  json document = lego();
  for (const Pointer& place : places(lego()))
    if (place.back() == "flip") document[place] = nullptr;
  EXPECT_EQ(written(read_text(document.dump())), document);
  document["drawing"]["configurations"][2]["e_render"]["flip"] = 0.5;
  EXPECT_THAT(refusal(document.dump()),
              HasSubstr("drawing.configurations[2].e_render.flip: expected null"));
}

TEST(TradeoffReading, MissesEveryKeyThatIsNotThere) {
  const json whole = with_photographs();
  for (const Pointer& place : places(whole)) {
    if (!whole[place.parent_pointer()].is_object()) continue;
    json document = whole;
    document[place.parent_pointer()].erase(place.back());
    const std::string sentence = refusal(document.dump());
    // Without its name it is not even known to be ours.
    const std::string expected = place.back() == "format" ? "no result of tureen tradeoff"
                                                          : "lacks \"" + place.back() + "\"";
    EXPECT_THAT(sentence, HasSubstr(expected)) << place.to_string();
  }
}

TEST(TradeoffReading, RefusesValuesOfAnotherKind) {
  const json whole = with_photographs();
  for (const Pointer& place : places(whole))
    for (const json& other : {json::object(), json::array({nullptr}), json(-1), json(true)}) {
      // Pictures may be as unlike as an SSIM of -1.
      if (whole[place].type() == other.type() || (place.back() == "ssim" && other == -1)) continue;
      json document = whole;
      document[place] = other;
      EXPECT_NE(refusal(document.dump()), "") << place.to_string() << " as " << other;
    }
}

struct Bad {
  const char* pointer;
  json value;
  const char* words;
};

TEST(TradeoffReading, RefusesWhatCannotBe) {
  const json lego_knobs = lego()["drawing"]["knobs"];
  const json many(20001, nullptr);
  const std::vector<Bad> all{
      {"/format", "tureen bench", "lego.json: this is no result of tureen tradeoff"},
      {"/version", 0, "version: there is no version 0"},
      {"/version", 2, "version: version 2 is newer than this program"},
      {"/date", "yesterday", "date: expected a time of the form"},
      {"/scene/name", std::string(4097, 'x'), "scene.name: has 4097 bytes, at most 4096"},
      {"/drawing/configurations/0/name", std::string(1001, 'x'), "name: has 1001 bytes, at most"},
      {"/scene/triangles", -1, "scene.triangles: expected a whole number"},
      {"/protocol/width", 0, "protocol.width: 0 is not enough"},
      {"/protocol/views", 2,
       "subpixel_grid.view_psnr_db: has 1 elements, expected one for each of 2"},
      {"/protocol/samples", "best", "protocol.samples: \"best\" is none of device, exact"},
      {"/limits/most_coverage_mismatch", 2, "2 is not from 0 to 1"},
      {"/drawing/knobs/0/settings", json::array(), "drawing.knobs[0].settings: is empty"},
      {"/drawing/knobs/0/settings", {"3", "3"}, "holds \"3\" twice"},
      {"/drawing/knobs/0/settings", json(65, "3"), "has 65 elements, at most 64"},
      {"/drawing/knobs/1/key", "lattice_level", "drawing.knobs[1].key: \"lattice_level\" is there"},
      {"/drawing/knobs", json(65, lego_knobs[0]), "drawing.knobs: has 65 elements"},
      {"/drawing/configurations", json::array(), "drawing.configurations: is empty"},
      {"/drawing/configurations", many, "has 20001 elements, at most 20000 are expected"},
      {"/drawing/configurations/0/method", "published", "configurations[1]: the same method"},
      {"/drawing/configurations/0/method", "by hand", "\"by hand\" is none of tureen"},
      {"/drawing/configurations/2/knobs/site", "sideways",
       "drawing.configurations[2].knobs.site: is no setting of the knob site"},
      {"/drawing/configurations/2/knobs/colour", "red", "holds knobs that the panel lacks"},
      {"/drawing/configurations/2/knobs/lattice_level", "3", "[2]: the same method and knobs"},
      {"/drawing/configurations/2/ms", nullptr, "configurations[2].ms: expected a number"},
      {"/drawing/configurations/2/ms", 0, "configurations[2].ms: 0 is not from 1e-06 to 1e+09"},
      {"/drawing/configurations/2/ms", 1e300, "1e+300 is not from"},
      {"/drawing/configurations/5/ms", 3, "configurations[5].ms: expected null: the oracle"},
      {"/drawing/configurations/2/e_render/psnr_db", 101, "101 is not from 0 to 100"},
      {"/drawing/configurations/2/e_render/psnr_db", -1, "-1 is not from 0 to 100"},
      {"/drawing/configurations/2/e_render/view_psnr_db", {40, 40}, "2 elements, expected one"},
      {"/drawing/configurations/2/on_front", false, "the panel's front says otherwise"},
      {"/drawing/configurations/2/e_model",
       {{"psnr_db", 1}, {"ssim", 0}, {"flip", 0}},
       "the run has no photographs"},
      {"/drawing/front", {2, 0, 0}, "drawing.front[2]: stands there twice"},
      {"/drawing/front/0", 6, "drawing.front[0]: 6 is beyond 5"},
      {"/drawing/front/0", 5, "drawing.front[0]: has no time"},
      {"/drawing/aa_spread", -0.1, "drawing.aa_spread"},
      {"/antialiasing/configurations/0/knobs/resolution_scale", "0.5",
       "antialiasing.configurations[1]: the same method and knobs"},
      {"/r0", 0, "r0: is not drawn by the published pipeline"},
      {"/r0", 6, "r0: 6 is beyond 5"},
      {"/choice/configuration", 5, "choice.configuration: has no time"}};
  for (const Bad& bad : all) {
    json document = lego();
    document[Pointer(bad.pointer)] = bad.value;
    EXPECT_THAT(refusal(document.dump()), HasSubstr(bad.words)) << bad.pointer;
  }
}

TEST(TradeoffReading, APanelBeginsWithTheDefaults) {
  json document = lego();
  std::swap(document["drawing"]["configurations"][0], document["drawing"]["configurations"][2]);
  EXPECT_THAT(
      refusal(document.dump()),
      HasSubstr("drawing.configurations[0]: is not the defaults, with which a panel begins"));
}

TEST(TradeoffReading, NumbersThatAreNoneAreNoJson) {
  const std::string text = lego().dump();
  const std::string key = "\"aa_spread\":";
  const std::size_t at = text.find(key) + key.size();
  const std::size_t end = text.find(',', at);
  const auto with = [&](const char* number) {
    std::string damaged = text;
    return damaged.replace(at, end - at, number);
  };
  for (const char* number : {"NaN", "nan", "Infinity", "-inf"})
    EXPECT_THAT(refusal(with(number)), HasSubstr("not valid JSON")) << number;
  EXPECT_THAT(refusal(with("1e999")), HasSubstr("the number 1e999 is too large"));
}

}  // namespace
}  // namespace tureen::cli
