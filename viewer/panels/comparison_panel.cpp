// Compares the image with the photograph of the same camera.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void dataset_buttons(State& state) {
  if (!state.started) {
    if (strong_button("Train a scene")) state.ask(OfferTraining{});
    tip("tureen train with these photographs; asks for the file first");
    beside("Copy the command");
  }
  if (button("Copy the command")) state.ask(CopyTrainingCommand{});
  tip("The command that trains a scene, for a terminal");
  beside("Close");
  if (button("Close")) state.ask(CloseDataset{});
  tip("Closes the dataset");
}

void started_training_rows(State& state) {
  if (!state.started) return;
  aside("Training " + state.started->scene.string());
  const Disabled disabled(state.started->is_stopped);
  if (button(state.started->is_stopped ? "Stopping .." : "Stop the training"))
    state.ask(StopTraining{});
  tip("Stops after the current step and writes a checkpoint, from which the training can continue");
}

void comparison_panel(State& state) {
  started_training_rows(state);
  if (!state.photographs) {
    aside(
        "Drop a dataset on the window (COLMAP, transforms.json) to use its cameras and to compare "
        "with its photographs.");
    return;
  }
  Comparison& comparison = state.comparison;
  static constexpr const char* choices[] = {"Off", "Split", "Photograph", "Difference"};
  int show = static_cast<int>(comparison.show);
  segments("show", choices, show);
  tip("C changes it");
  comparison.show = static_cast<Comparison::Show>(show);

  const Photograph* photograph = state.photograph();
  if (!photograph) {
    aside("Select a recorded camera with [ and ] to compare with its photograph.");
    dataset_buttons(state);
    return;
  }
  const bool training = std::size_t(state.recorded) < state.photographs->train_count;
  aside(photograph->camera.name + (training ? ", used for training" : ", held out"));
  if (comparison.result) {
    const Metrics& metrics = comparison.result->metrics;
    text("PSNR {:.2f} dB, SSIM {:.4f}", metrics.psnr_db, metrics.ssim);
    aside(fmt::format("this view, {} \u00d7 {} pixels, {}", photograph->camera.width,
                      photograph->camera.height, describe(state.source.document.quality)));
  } else if (comparison.show != Comparison::Show::off) {
    aside("comparing ..");
  }
  if (comparison.show == Comparison::Show::difference) legend_rows(difference_legend());
  dataset_buttons(state);
}

}  // namespace tureen::viewer
