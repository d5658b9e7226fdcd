#include "cli/files/eval_images.hpp"

#include <gmock/gmock.h>

namespace tureen::cli {
namespace eval_images_test {

using testing::ElementsAre;

std::vector<Photograph> named(const std::vector<std::string>& names) {
  std::vector<Photograph> photographs(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) photographs[i].camera.name = names[i];
  return photographs;
}

TEST(ImageNames, AreFlatSafeAndDistinct) {
  EXPECT_THAT(
      image_names(named({"./test/r_0", "images/IMG_7.JPG", "images/IMG_7.png", "../../etc/x.png",
                         "a b:c.png", ".hidden.png", "", "contact_sheet.jpg"})),
      ElementsAre("test_r_0.png", "images_IMG_7.png", "images_IMG_7_2.png", "etc_x.png",
                  "a_b_c.png", "hidden.png", "view.png", "contact_sheet_2.png"));
}

}  // namespace eval_images_test
}  // namespace tureen::cli
