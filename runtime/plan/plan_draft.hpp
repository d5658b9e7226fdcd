// A plan under construction, shared by the parts of make_plan() for each appearance. Internal to
// runtime/: users include plan.hpp.
#pragma once

#include "runtime/plan/plan.hpp"

namespace tureen {

/// Half a step of an 8-bit colour: the largest change by a specialisation.
inline constexpr float half_step = 0.5f / 255.0f;

/// Converts a change of a colour in [0, 1] to steps of 8 bits, as in AppliedSpecialisation::margin.
constexpr double steps_of(double change) { return 255.0 * change; }

struct PlanDraft {
  const TriangleSoup& soup;
  PlanPreferences preferences;
  SoupPlan plan;

  /// Whether the caller allows this specialisation.
  bool may(Specialisation what) const {
    return preferences.specialise && preferences.specialisations.has(what) &&
           preferences.of_soups.has(what);
  }
  void apply(const AppliedSpecialisation& specialisation) {
    plan.applied.push_back(specialisation);
  }
};

/// Chooses the drawn faces, those without an alpha test, and the clusters.
void plan_faces(PlanDraft& draft, const DeviceLimits& limits);

// The parts of an appearance that remain necessary for the chosen faces.
void plan_appearance(PlanDraft& draft, const FaceColors& colors);
void plan_appearance(PlanDraft& draft, const VertexColors& colors);
void plan_appearance(PlanDraft& draft, const Harmonics& harmonics);
void plan_appearance(PlanDraft& draft, const LatticeTexture& texture);
void plan_appearance(PlanDraft& draft, const UvTextures& textures);

/// Chooses the form of a network's weights in the shader, and the necessary weights.
void plan_network(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& ranges);

}  // namespace tureen
