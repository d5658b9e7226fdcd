// Notes fade, errors stay.
#include "viewer/messages.hpp"

#include <gtest/gtest.h>

namespace tureen::viewer {
namespace messages_test {

TEST(Messages, NotesFadeAndErrorsStay) {
  Messages messages;
  messages.note("saved", 1.0);
  messages.error("bad.glb", "it is cut short", 1.0);
  EXPECT_TRUE(messages.fading());
  messages.age(1.0 + Messages::note_seconds + 0.1);
  ASSERT_EQ(messages.list().size(), 1u);
  EXPECT_EQ(messages.list()[0].title, "bad.glb");
  EXPECT_FALSE(messages.fading());
  messages.dismiss(0);
  EXPECT_TRUE(messages.list().empty());
}

TEST(Messages, TheSameAgainIsNotASecondOne) {
  Messages messages;
  for (int i = 0; i < 3; ++i) messages.error("bad.glb", "it is cut short", i);
  EXPECT_EQ(messages.list().size(), 1u);
  for (int i = 0; i < 30; ++i) messages.note(std::to_string(i), i);
  EXPECT_EQ(messages.list().size(), Messages::most);
  EXPECT_EQ(messages.list().back().text, "29");
}

TEST(Messages, ErrorsAboutOpeningEndWithTheNextFile) {
  Messages messages;
  messages.note("saved", 1.0);
  messages.error("soup-1.png", "the disk is full", 1.0);
  messages.error("bad.glb", "it is cut short", 1.0, Message::About::opening);
  messages.error("soup.glb", "it is cut short", 1.0, Message::About::scene);
  messages.dismiss_opening();
  ASSERT_EQ(messages.list().size(), 2u);
  EXPECT_EQ(messages.list()[1].title, "soup-1.png");
}

TEST(Messages, ThoseAboutOpeningStayWhenTheSceneIsReadAgain) {
  Messages messages;
  messages.error("bad.glb", "it is cut short", 1.0, Message::About::opening);
  messages.error("soup.glb", "it is cut short", 1.0, Message::About::scene);
  messages.dismiss_scene();
  ASSERT_EQ(messages.list().size(), 1u);
  EXPECT_EQ(messages.list()[0].title, "bad.glb");
}

TEST(Messages, OfFilesDoNotFillTheWindow) {
  Messages messages;
  messages.error("bad.glb", "it wants " + std::string(1'000'000, 'x') + "\nall is well", 1.0);
  const std::string& text = messages.list()[0].text;
  EXPECT_LT(text.size(), 1100u);
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

}  // namespace messages_test
}  // namespace tureen::viewer
