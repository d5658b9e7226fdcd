#include "runtime/leave_out.hpp"

#include <cassert>

namespace tureen {

namespace {

constexpr LeaveOutName names[] = {
    {LeaveOut::alpha_test, "alpha-test", "the alpha test of opaque faces"},
    {LeaveOut::transparent_faces, "transparent-faces", "faces that are transparent throughout"},
    {LeaveOut::coincident_faces, "coincident-faces",
     "faces behind an opaque one of the same corners"},
    {LeaveOut::faces_between_pixels, "faces-between-pixels", "faces that cover no pixel's centre"},
    {LeaveOut::shading_pass, "shading-pass", "the shading pass of cheap colours"},
    {LeaveOut::background, "background", "shading of background pixels"},
    {LeaveOut::interpolation, "interpolation", "interpolation of equal vertex colours"},
    {LeaveOut::harmonics_bands, "harmonics-bands", "harmonics bands that nobody sees"},
    {LeaveOut::color_mlp, "color-mlp", "a color MLP that never blends in"},
    {LeaveOut::view_direction, "view-direction", "a view direction that moves no colour"},
    {LeaveOut::weight_uniforms, "weight-uniforms", "uniforms for the network's weights"},
    {LeaveOut::dead_neurons, "dead-neurons", "neurons that never fire and weights of zero"},
    {LeaveOut::latent_features, "latent-features", "latent features that are the same everywhere"},
    {LeaveOut::constant_lattices, "constant-lattices", "lattices of faces that have one colour"},
    {LeaveOut::affine_texels, "affine-texels", "texels of affine faces but for their corners"},
};

}  // namespace

std::span<const LeaveOutName> leave_out_names() { return names; }

const char* name_of(LeaveOut what) {
  assert(names[std::size_t(what)].what == what);
  return names[std::size_t(what)].name;
}

std::optional<LeaveOut> leave_out_named(std::string_view name) {
  for (const LeaveOutName& known : names)
    if (known.name == name) return known.what;
  return std::nullopt;
}

}  // namespace tureen
