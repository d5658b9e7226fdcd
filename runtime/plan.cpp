#include "runtime/plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "runtime/color_mlp_source.hpp"
#include "runtime/face_alpha.hpp"
#include "runtime/lattice_traits.hpp"
#include "soup/error.hpp"
#include "soup/lattice.hpp"
#include "soup/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Half a step of an 8-bit colour: nothing that is not exact may change a colour by more.
constexpr float half_step = 0.5f / 255.0f;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

class Planner {
 public:
  Planner(const TriangleSoup& soup, const DeviceLimits& limits, const PlanPreferences& preferences)
      : soup_(soup), preferences_(preferences) {
    plan_.pipeline = preferences.pipeline;
    plan_.reversed_depth = limits.clip_control && preferences.reversed_depth &&
                           preferences.pipeline == PipelineKind::tureen;
  }

  RenderPlan make() {
    if (plan_.pipeline == PipelineKind::published) return published();
    choose_faces();
    std::visit([this](const auto& appearance) { plan_appearance(appearance); }, soup_.appearance);
    choose_site();
    describe_drawing();
    return std::move(plan_);
  }

 private:
  bool specialise() const { return preferences_.specialise; }
  void say(std::string sentence) { plan_.sentences.push_back(std::move(sentence)); }

  RenderPlan published() {
    const auto* texture = std::get_if<LatticeTexture>(&soup_.appearance);
    if (!texture || !texture->mlp)
      throw UsageError(
          std::string("the published pipeline draws lattice textures with a color MLP; "
                      "this soup has ") +
          appearance_name(soup_.appearance));
    const std::uint32_t level = texture->patches.empty() ? 0 : texture->patches.front().level;
    for (const LatticePatch& patch : texture->patches)
      if (patch.level != level)
        throw UsageError("the published pipeline knows one lattice level for all faces");
    for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t)
      if (drawable(soup_, t)) plan_.faces.push_back(t);
    plan_.color_mlp = true;
    plan_.lattice.uniform_level = int(level);
    say("published pipeline: two RGBA8 feature targets, every fragment samples all eight channels, "
        "faces in file order, the network on every pixel with its weights in uniforms");
    return std::move(plan_);
  }

  /// Which faces are drawn, which of them without an alpha test, and in what runs.
  void choose_faces() {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t)
      if (drawable(soup_, t)) faces.push_back(t);
    const std::size_t undrawable = soup_.triangles.size() - faces.size();
    if (undrawable > 0)
      say(format("left out: %zu faces without area or with corners that are not finite",
                 undrawable));

    std::vector<FaceAlpha> alpha(soup_.triangles.size(), FaceAlpha::cut_out);
    if (specialise()) {
      alpha = classify_alpha(soup_);
      const std::size_t before = faces.size();
      std::erase_if(faces, [&](std::uint32_t t) { return alpha[t] == FaceAlpha::transparent; });
      if (faces.size() < before)
        say(format("left out: %zu of %zu faces are transparent throughout (exact)",
                   before - faces.size(), before));
    }

    sort_spatially(soup_, faces);
    // Of coincident faces the lower index must win, so both kinds of them are drawn in one bucket.
    for (std::size_t i = 0; i < faces.size();) {
      std::size_t end = i + 1;
      bool mixed = false;
      for (; end < faces.size() && coincident(soup_, faces[i], faces[end]); ++end)
        mixed = mixed || alpha[faces[end]] != alpha[faces[i]];
      for (std::size_t k = i; mixed && k < end; ++k) alpha[faces[k]] = FaceAlpha::cut_out;
      i = end;
    }
    const auto first_cut_out = std::stable_partition(
        faces.begin(), faces.end(), [&](std::uint32_t t) { return alpha[t] == FaceAlpha::opaque; });
    plan_.opaque_count = std::size_t(first_cut_out - faces.begin());
    plan_.faces = std::move(faces);
    if (plan_.opaque_count == plan_.faces.size() && !plan_.faces.empty())
      say("left out: the alpha test, every face is opaque throughout (exact)");
    else if (plan_.opaque_count > 0)
      say(format("left out: the alpha test of %zu of %zu faces, opaque throughout (exact)",
                 plan_.opaque_count, plan_.faces.size()));

    const auto opaque = std::uint32_t(plan_.opaque_count), all = std::uint32_t(plan_.faces.size());
    const std::uint32_t size = cluster_size(plan_.faces.size());
    append_clusters(soup_, plan_.faces, 0, opaque, size, plan_.clusters);
    append_clusters(soup_, plan_.faces, opaque, all, size, plan_.clusters);
  }

  void plan_appearance(const FaceColors&) { plan_.flat_colors = true; }

  void plan_appearance(const VertexColors& colors) {
    if (!specialise() || plan_.opaque_count < plan_.faces.size()) return;
    for (const std::uint32_t t : plan_.faces) {
      const glm::uvec3& v = soup_.triangles[t];
      if (colors.rgba[v.x] != colors.rgba[v.y] || colors.rgba[v.x] != colors.rgba[v.z]) return;
    }
    plan_.flat_colors = true;
    say("left out: interpolation, the three vertex colours of every face are equal (exact)");
  }

  void plan_appearance(const Harmonics& sh) {
    plan_.harmonics_degree = sh.degree;
    if (!specialise()) return;
    // |sum_m Y_lm(d) c_m| <= sqrt((2l+1) / 4 pi) |c_l| for every direction (Cauchy-Schwarz and the
    // addition theorem); the bands above the degree kept may together move no channel further.
    const std::size_t elements = sh.coefficients.size() / harmonics::count(sh.degree);
    std::vector<double> worst(std::size_t(sh.degree) + 1, 0.0);  // above[l]: bands l.. together
    for (std::size_t e = 0; e < elements; ++e) {
      glm::dvec3 above(0.0);
      for (int l = sh.degree; l > 0; --l) {
        glm::dvec3 energy(0.0);
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
          const glm::dvec3 c = sh.coefficients[e * harmonics::count(sh.degree) + i];
          energy += c * c;
        }
        above += std::sqrt((2 * l + 1) / (4 * M_PI)) * glm::sqrt(energy);
        worst[l] = std::max({worst[l], above.x, above.y, above.z});
      }
    }
    while (plan_.harmonics_degree > 0 && worst[plan_.harmonics_degree] < half_step)
      --plan_.harmonics_degree;
    if (plan_.harmonics_degree < sh.degree)
      say(format(
          "left out: harmonics above degree %d of %d, they change no colour by more than %.5f "
          "(1/510 = 0.00196 allowed)",
          plan_.harmonics_degree, sh.degree, worst[plan_.harmonics_degree + 1]));
  }

  void plan_appearance(const LatticeTexture& texture) {
    plan_.color_mlp = texture.mlp.has_value();
    if (!specialise()) return;

    const LatticeTraits traits = measure(texture, plan_.faces);
    if (plan_.color_mlp && texture.mlp->blend_channel) {
      const FeatureRange& range = traits.ranges[*texture.mlp->blend_channel];
      const float blend = std::max(range.high, -range.low);
      if (blend <= half_step) {
        plan_.color_mlp = false;
        say(
            format("left out: the color MLP, its blend channel never exceeds %.5f (1/510 = 0.00196 "
                   "allowed)",
                   double(blend)));
      }
    }
    if (plan_.color_mlp) use_constants(*texture.mlp, traits.ranges);

    const double gain = plan_.color_mlp ? color_gain(texture) : 1.0;
    plan_lattice(texture, traits, gain);
  }

  void use_constants(const ColorMlp& mlp, const FeatureRanges& ranges) {
    plan_.weights_as_constants = true;
    plan_.feature_ranges = ranges;
    const ColorMlpSource source = color_mlp_source(mlp, MlpWeights::constants, ranges);
    std::string sentence = "network weights are compiled in as constants";
    if (source.dead_neurons > 0 || source.zero_weights > 0)
      sentence += format(
          "; left out: %d of %d hidden neurons that never fire and %d weights of zero "
          "(exact)",
          source.dead_neurons, source.hidden_neurons, source.zero_weights);
    say(std::move(sentence));
  }

  /// `gain`: how much an error of the features may grow on its way to the colour.
  void plan_lattice(const LatticeTexture& texture, const LatticeTraits& traits, double gain) {
    const std::size_t count = plan_.faces.size();
    if (count == 0) return;
    const bool one_level = traits.lowest_level == traits.highest_level;
    if (!plan_.color_mlp && traits.constant_faces == count &&
        plan_.opaque_count == plan_.faces.size()) {
      plan_.flat_colors = true;
      say("left out: the lattice, every face has one colour (exact)");
      return;
    }
    std::vector<std::uint8_t> levels(count);
    std::size_t texels = 0, kept = 0, affine_faces = 0;
    double largest_error = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const int level = int(texture.patches[plan_.faces[i]].level);
      const double error = gain * double(traits.affine_residual[i]);
      const bool affine = error <= double(half_step);
      levels[i] = affine ? std::uint8_t(0) : std::uint8_t(level);
      texels += lattice::texel_count(level);
      kept += lattice::texel_count(levels[i]);
      affine_faces += affine ? 1 : 0;
      if (affine) largest_error = std::max(largest_error, error);
    }
    const bool all_affine = affine_faces == count;
    // Faces of unlike levels need a table read a fragment; a quarter of the texels saved pays for
    // it, as does a scene that needs the table anyway.
    const bool worth_it = all_affine || !one_level || kept < texels - texels / 4;
    if (kept < texels && worth_it && !traits.shares_texels) {
      plan_.lattice.levels = std::move(levels);
      if (all_affine) plan_.lattice.uniform_level = 0;
      say(
          format("left out: %zu of %zu texels, %zu faces are affine (%zu constant) and keep their "
                 "corners (no colour changes by more than %.5f, 1/510 = 0.00196 allowed)",
                 texels - kept, texels, affine_faces, traits.constant_faces, largest_error));
    } else if (one_level && !traits.shares_texels) {
      plan_.lattice.uniform_level = traits.highest_level;
    }
    if (plan_.lattice.uniform_level >= 0)
      say(format("left out: the table of texels, every face has level %d (exact)",
                 plan_.lattice.uniform_level));
  }

  void plan_appearance(const UvTextures& textures) {
    plan_.color_mlp = textures.mlp.has_value();
    if (specialise() && plan_.color_mlp) use_constants(*textures.mlp, {});
  }

  void choose_site() {
    // One or three reads make a colour: a second pass over the pixels costs more than it saves.
    const bool cheap = plan_.flat_colors ||
                       std::holds_alternative<VertexColors>(soup_.appearance) ||
                       (std::holds_alternative<UvTextures>(soup_.appearance) && !plan_.color_mlp);
    plan_.site = preferences_.site.value_or(cheap ? ShadingSite::forward : ShadingSite::deferred);
    plan_.depth_rejects_background = specialise() && plan_.site == ShadingSite::deferred;
    if (plan_.depth_rejects_background)
      say("left out: shading of background pixels, the depth test rejects them (exact)");
    if (specialise() && plan_.site == ShadingSite::forward)
      say("left out: the shading pass, colours are cheap enough to write at once (exact)");
  }

  void describe_drawing() {
    std::string sentence =
        format("draws %zu of %zu faces (%s), near ones first in %zu clusters, ", plan_.faces.size(),
               soup_.triangles.size(), appearance_name(soup_.appearance), plan_.clusters.size());
    sentence += plan_.site == ShadingSite::forward ? "colour in one pass"
                                                   : "a visibility pass, then colour once a pixel";
    if (plan_.color_mlp) sentence += " by the color MLP";
    sentence += plan_.reversed_depth ? "; reversed depth" : "; ordinary depth range";
    if (!specialise()) sentence += "; nothing is left out, as asked";
    plan_.sentences.insert(plan_.sentences.begin(), std::move(sentence));
  }

  const TriangleSoup& soup_;
  PlanPreferences preferences_;
  RenderPlan plan_;
};

}  // namespace

RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences) {
  if (preferences.preset && !is_faithful(*preferences.preset))
    throw UsageError("this runtime does not draw with a preset yet: " +
                     describe(*preferences.preset));
  return Planner(soup, limits, preferences).make();
}

}  // namespace tureen
