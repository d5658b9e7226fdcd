#include "runtime/plan/specialisation.hpp"

#include <cassert>

namespace tureen {

namespace {

constexpr SpecialisationName specialisations[] = {
    {Specialisation::alpha_test, "alpha-test", "no alpha test for opaque faces"},
    {Specialisation::transparent_faces, "transparent-faces", "no fully transparent faces"},
    {Specialisation::coincident_faces, "coincident-faces",
     "no faces behind an opaque one with the same corners"},
    {Specialisation::small_triangles, "faces-between-pixels", "no faces between pixel centres"},
    {Specialisation::shading_pass, "shading-pass", "no shading pass for cheap colours"},
    {Specialisation::background, "background", "no shading of background pixels"},
    {Specialisation::interpolation, "interpolation", "no interpolation of equal vertex colours"},
    {Specialisation::harmonics_bands, "harmonics-bands", "no harmonics bands without effect"},
    {Specialisation::color_mlp, "color-mlp", "no color MLP if never blended in"},
    {Specialisation::view_direction, "view-direction", "no view direction without effect"},
    {Specialisation::weight_uniforms, "weight-uniforms", "network weights as constants"},
    {Specialisation::dead_neurons, "dead-neurons", "no dead neurons"},
    {Specialisation::latent_features, "latent-features", "no constant latent features"},
    {Specialisation::constant_lattices, "constant-lattices", "no lattices of one colour"},
    {Specialisation::affine_texels, "affine-texels", "affine faces by their corners"},
    {Specialisation::transparent_splats, "transparent-splats", "no fully transparent splats"},
    {Specialisation::hidden_splats, "hidden-splats", "no splats behind closed pixels"},
};

}  // namespace

std::span<const SpecialisationName> specialisation_names() { return specialisations; }

const char* name_of(Specialisation what) {
  assert(specialisations[std::size_t(what)].what == what);
  return specialisations[std::size_t(what)].name;
}

std::optional<Specialisation> specialisation_named(std::string_view name) {
  for (const SpecialisationName& known : specialisations)
    if (known.name == name) return known.what;
  return std::nullopt;
}

}  // namespace tureen
