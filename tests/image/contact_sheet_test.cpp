#include "image/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tureen {
namespace contact_sheet_test {

/// Five images of one colour each: of two columns and three rows, the sheet is nearest to a square.
TEST(ContactSheet, HasRowsOfThumbnailsWithMargins) {
  std::vector<Image8> images;
  for (int i = 0; i < 5; ++i) images.emplace_back(40, 30, glm::u8vec4(50 * i, 9, 9, 255));
  const Image8 sheet = contact_sheet(images, 20);
  const Image8 small = thumbnail(images[0], 20);
  ASSERT_EQ(small.width, 20);
  ASSERT_EQ(small.height, 15);
  // One margin more than there are columns or rows.
  const int columns = 2, rows = 3;
  const int margin = (sheet.width - columns * 20) / (columns + 1);
  EXPECT_GT(margin, 0);
  EXPECT_EQ(sheet.width, columns * (20 + margin) + margin);
  EXPECT_EQ(sheet.height, rows * (15 + margin) + margin);
  for (int i = 0; i < 5; ++i) {
    const int left = margin + i % columns * (20 + margin),
              top = margin + i / columns * (15 + margin);
    EXPECT_EQ(sheet.at(left, top), images[std::size_t(i)].at(0, 0)) << i;
    EXPECT_EQ(sheet.at(left + 19, top + 14), images[std::size_t(i)].at(0, 0)) << i;
    EXPECT_EQ(sheet.at(left + 20, top).a, 0) << i;
    EXPECT_EQ(sheet.at(left, top + 15).a, 0) << i;
  }
  // A cell of one pixel without an image.
  EXPECT_EQ(contact_sheet({}, 20).width, 1 + 2 * margin);
  EXPECT_EQ(contact_sheet({}, 20).height, 1 + 2 * margin);
}

}  // namespace contact_sheet_test
}  // namespace tureen
