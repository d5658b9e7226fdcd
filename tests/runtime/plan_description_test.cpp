// The English descriptions of plans. Other tests check a plan's fields.
#include "runtime/plan/plan_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen {
namespace plan_description_test {

using testing::ElementsAre;

TEST(PlanDescription, HasASentenceForEachFact) {
  RenderPlan plan;
  plan.reversed_depth = true;
  plan.add(SoupPlan{});
  plan.soup(0).faces = {4, 2, 0};
  plan.soup(0).clusters.resize(1);
  plan.soup(0).color_mlp = true;
  plan.soup(0).appearance = "lattice texture";
  plan.soup(0).soup_faces = 6;
  plan.soup(0).undrawable_faces = 2;
  plan.soup(0).applied = {{Specialisation::transparent_faces, 1, 4}, {Specialisation::background}};
  plan.requested_stage = plan.soup(0).shading_stage = ShadingStage::compute;
  EXPECT_THAT(
      describe(plan),
      ElementsAre(
          "draws 3 of 6 faces (lattice texture), near ones first in 1 clusters, a "
          "visibility pass, then colour once a pixel by the color MLP; reversed depth",
          "2 faces without area or with corners that are not finite are not drawn",
          "transparent-faces: 1 of 4 faces are transparent throughout and not drawn (exact)",
          "background: the depth test rejects background pixels before shading (exact)",
          "shading runs as compute, as requested"));
}

TEST(PlanDescription, GivesTheMarginOfASpecialisation) {
  EXPECT_EQ(describe(AppliedSpecialisation{Specialisation::affine_texels, 7, 9, 0.25}),
            "affine-texels: 7 of 9 faces are affine and keep only their corner texels (changes "
            "colours by at most 0.250 of an 8-bit step)");
  EXPECT_EQ(describe(AppliedSpecialisation{Specialisation::shading_pass}),
            "shading-pass: colours are written in the only pass, because they cost little (exact "
            "up to rounding)");
}

TEST(PlanDescription, EverySpecialisationBeginsWithItsName) {
  for (const SpecialisationName& known : specialisation_names())
    EXPECT_TRUE(
        describe(AppliedSpecialisation{known.what}).starts_with(std::string(known.name) + ": "));
}

}  // namespace plan_description_test
}  // namespace tureen
