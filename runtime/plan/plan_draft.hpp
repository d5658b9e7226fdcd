// A plan while it is being made: what each appearance's part of make_plan() reads and writes.
// Internal to runtime/: users want plan.hpp.
#pragma once

#include "runtime/plan/plan.hpp"

namespace tureen {

/// Half a step of an 8-bit colour: no specialisation may change a colour by more.
inline constexpr float half_step = 0.5f / 255.0f;

/// A change of a colour in [0, 1] in steps of 8 bits, as AppliedSpecialisation::margin.
constexpr double steps_of(double change) { return 255.0 * change; }

struct PlanDraft {
  const TriangleSoup& soup;
  PlanPreferences preferences;
  RenderPlan plan;

  /// Whether the caller allows this specialisation.
  bool may(Specialisation what) const {
    return preferences.specialise && preferences.specialisations.has(what);
  }
  void apply(const AppliedSpecialisation& specialisation) {
    plan.applied.push_back(specialisation);
  }
};

/// Which faces are drawn, which of them without an alpha test, and in what runs.
void plan_faces(PlanDraft& draft, const DeviceLimits& limits);

// What is left of an appearance, once the faces are known.
void plan_appearance(PlanDraft& draft, const FaceColors& colors);
void plan_appearance(PlanDraft& draft, const VertexColors& colors);
void plan_appearance(PlanDraft& draft, const Harmonics& harmonics);
void plan_appearance(PlanDraft& draft, const LatticeTexture& texture);
void plan_appearance(PlanDraft& draft, const UvTextures& textures);

/// How the weights of a network that runs reach the shader, and which of them.
void plan_network(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& ranges);

/// The whole plan of the published pipeline. Throws UsageError when it cannot draw this soup.
void plan_published(PlanDraft& draft);

}  // namespace tureen
