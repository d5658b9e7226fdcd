// Compares the image with the photograph of the same camera.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void comparison_panel(State& state) {
  if (!state.photographs) {
    aside(
        "Drop a dataset on the window (COLMAP, transforms.json) to use its cameras and to compare "
        "with its photographs.");
    return;
  }
  Comparison& comparison = state.comparison;
  int show = static_cast<int>(comparison.show);
  ImGui::RadioButton("off", &show, 0);
  ImGui::SameLine();
  ImGui::RadioButton("split", &show, 1);
  ImGui::SameLine();
  ImGui::RadioButton("photograph", &show, 2);
  ImGui::SameLine();
  ImGui::RadioButton("difference", &show, 3);
  comparison.show = static_cast<Comparison::Show>(show);

  const Photograph* photograph = state.photograph();
  if (!photograph) {
    aside("Select a recorded camera with [ and ] to compare with its photograph.");
    return;
  }
  const bool training = std::size_t(state.recorded) < state.photographs->train_count;
  aside(photograph->camera.name + (training ? ", used for training" : ", held out"));
  if (comparison.result) {
    const Metrics& metrics = comparison.result->metrics;
    text("PSNR {:.2f} dB, SSIM {:.4f}", metrics.psnr_db, metrics.ssim);
    aside(fmt::format("at the photograph's {} x {} pixels", photograph->camera.width,
                      photograph->camera.height));
  } else if (comparison.show != Comparison::Show::off) {
    aside("comparing ..");
  }
  if (comparison.show == Comparison::Show::difference) legend_rows(difference_legend());
  if (ImGui::Button("Close the dataset")) state.ask(CloseDataset{});
}

}  // namespace tureen::viewer
