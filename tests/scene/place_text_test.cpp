// Places of layers as text.
#include "scene/document/place_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>

#include "base/error.hpp"

namespace tureen {
namespace place_text_test {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

Scene three_layers() {
  Scene scene;
  for (const char* name : {"table", "a=b", ""}) scene.layers.push_back({.name = name});
  return scene;
}

TEST(PlaceText, RoundTrips) {
  const Similarity place{{1e-7, -2, 1.0 / 3}, {10, 20, 30}, 0.1, true};
  const std::string text = place_text("a=b", place, false);
  EXPECT_EQ(text, "a=b=at:1e-07,-2,0.3333333333333333/turn:10,20,30/scale:0.1/mirror/hidden");
  Scene scene = three_layers();
  place_layers(scene, {parse_place(text)});
  EXPECT_EQ(scene.layers[1].world_from_layer, matrix_of(place));
  EXPECT_FALSE(scene.layers[1].visible);
}

TEST(PlaceText, MissingPartsStay) {
  Scene scene = three_layers();
  const Similarity before{{1, 2, 3}, {10, 20, 30}, 2, true};
  scene.layers[2].world_from_layer = matrix_of(before);
  place_layers(scene, {parse_place("layer 3=at:4,5,6"), parse_place("table=hidden")});
  const glm::dmat4 expected =
      matrix_of({.position = {4, 5, 6}, .angles = before.angles, .scale = 2, .mirror = true});
  for (int column = 0; column < 4; ++column)  // to angles and back: rounding
    EXPECT_LT(glm::distance(scene.layers[2].world_from_layer[column], expected[column]), 1e-14);
  EXPECT_EQ(scene.layers[0].world_from_layer, glm::dmat4(1.0));
  EXPECT_FALSE(scene.layers[0].visible);
  place_layers(scene, {parse_place("layer 3=mirror:no/visible")});
  EXPECT_FALSE(similarity_of(scene.layers[2].world_from_layer).mirror);
}

TEST(PlaceText, ErrorsListWhatExists) {
  const auto read = [](const std::string& text) { return error_of([&] { parse_place(text); }); };
  EXPECT_THAT(read("table"), HasSubstr("has no NAME="));
  EXPECT_THAT(read("=at:1,2,3"), HasSubstr("has no NAME="));
  EXPECT_THAT(read("table=at:1,2"), HasSubstr("needs three numbers in 'at:1,2'"));
  EXPECT_THAT(read("table=at:1,2,x"), HasSubstr("needs three numbers"));
  EXPECT_THAT(read("table=scale:inf"), HasSubstr("needs a number"));
  EXPECT_THAT(read("table=scale:0x10"), HasSubstr("needs a number"));
  EXPECT_THAT(read("table=scale:0"), HasSubstr("not above 0"));
  EXPECT_THAT(read("table=scale:1/scale:2"), HasSubstr("two parts scale"));
  EXPECT_THAT(read("table=size:1"), HasSubstr("unknown part: 'size:1'"));
  EXPECT_THAT(read("table="), HasSubstr("unknown part: ''"));
  Scene scene = three_layers();
  const auto place = [&](const std::string& text) {
    return error_of([&] { place_layers(scene, {parse_place(text)}); });
  };
  EXPECT_THAT(place("fox=hidden"), HasSubstr("no layer has the name 'fox'"));
  EXPECT_THAT(place("table=turn:0,0,30/scale:2.5e-323"), HasSubstr("the place of table"));
  scene.layers[1].name = "table";
  EXPECT_THAT(place("table=hidden"), HasSubstr("several layers have the name 'table'"));
  place_layers(scene, {parse_place("layer 2=hidden")});
  EXPECT_FALSE(scene.layers[1].visible);
}

}  // namespace place_text_test
}  // namespace tureen
