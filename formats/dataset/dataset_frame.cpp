#include "formats/dataset/dataset_frame.hpp"

namespace tureen {

void add_faces(const DatasetFrame& frame, std::vector<DatasetFrame>& frames) {
  for (const PanoramaFace& face : panorama_faces) {
    DatasetFrame& view = frames.emplace_back(frame);
    view.name += "#" + std::string(face.name);
    view.face = &face;
    view.view_from_world = glm::dmat4(face.view_from_front) * frame.view_from_world;
    view.camera = [pose = view.view_from_world](int width, int) {
      Camera posed = face_camera(face_side(width));
      posed.view_from_world = pose;
      return posed;
    };
  }
}

}  // namespace tureen
