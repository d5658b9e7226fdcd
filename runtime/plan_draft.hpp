// A plan while it is being made: what each appearance's part of make_plan() reads and writes.
// Internal to runtime/: users want plan.hpp.
#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include "runtime/plan.hpp"

namespace tureen {

/// Half a step of an 8-bit colour: nothing that is not exact may change a colour by more.
inline constexpr float half_step = 0.5f / 255.0f;

/// printf's formatting into a string of at most 511 characters.
template <class... Values>
std::string formatted(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

struct PlanDraft {
  const TriangleSoup& soup;
  PlanPreferences preferences;
  RenderPlan plan;

  /// Whether the caller lets this be left out.
  bool may(Specialisation what) const {
    return preferences.specialise && preferences.specialisations.has(what);
  }
  void say(std::string sentence) { plan.sentences.push_back(std::move(sentence)); }
  /// `what` is left out; the sentence says so with the measured margin.
  void apply(Specialisation what, std::string sentence) {
    plan.left_out.add(what);
    say("left out: " + std::move(sentence));
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
