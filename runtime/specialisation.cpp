#include "runtime/specialisation.hpp"

#include <cassert>

namespace tureen {

namespace {

constexpr SpecialisationName names[] = {
    {Specialisation::alpha_test, "alpha-test", "the alpha test of opaque faces"},
    {Specialisation::transparent_faces, "transparent-faces",
     "faces that are transparent throughout"},
    {Specialisation::coincident_faces, "coincident-faces",
     "faces behind an opaque one of the same corners"},
    {Specialisation::faces_between_pixels, "faces-between-pixels",
     "faces that cover no pixel's centre"},
    {Specialisation::shading_pass, "shading-pass", "the shading pass of cheap colours"},
    {Specialisation::background, "background", "shading of background pixels"},
    {Specialisation::interpolation, "interpolation", "interpolation of equal vertex colours"},
    {Specialisation::harmonics_bands, "harmonics-bands", "harmonics bands that nobody sees"},
    {Specialisation::color_mlp, "color-mlp", "a color MLP that never blends in"},
    {Specialisation::view_direction, "view-direction", "a view direction that moves no colour"},
    {Specialisation::weight_uniforms, "weight-uniforms", "uniforms for the network's weights"},
    {Specialisation::dead_neurons, "dead-neurons", "neurons that never fire and weights of zero"},
    {Specialisation::latent_features, "latent-features",
     "latent features that are the same everywhere"},
    {Specialisation::constant_lattices, "constant-lattices",
     "lattices of faces that have one colour"},
    {Specialisation::affine_texels, "affine-texels",
     "texels of affine faces but for their corners"},
};

}  // namespace

std::span<const SpecialisationName> specialisation_names() { return names; }

const char* name_of(Specialisation what) {
  assert(names[std::size_t(what)].what == what);
  return names[std::size_t(what)].name;
}

std::optional<Specialisation> specialisation_named(std::string_view name) {
  for (const SpecialisationName& known : names)
    if (known.name == name) return known.what;
  return std::nullopt;
}

}  // namespace tureen
