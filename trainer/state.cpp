#include "trainer/state.hpp"

namespace tureen::trainer {

void Moments::reset_faces(const Model& model) {
  first.assign(model.logits.size(), 0.0f);
  second.assign(model.logits.size(), 0.0f);
  vertex_first.assign(model.positions.size(), glm::vec3(0));
  vertex_second.assign(model.positions.size(), 0.0f);
  steps.assign(model.faces(), 0);
}

}  // namespace tureen::trainer
