#include "formats/pickle.hpp"

#include <gmock/gmock.h>

#include "formats/format_testing.hpp"
#include "formats/torch_fixture.hpp"
#include "formats/truncation.hpp"

namespace tureen {
namespace {

using testing::as_bytes;
using ::testing::HasSubstr;
using testing::PickleFixture;
using Kind = Pickle::Kind;

constexpr std::string_view allowed[] = {"torch.FloatStorage"};

Pickle read(const std::string& bytes) { return Pickle("data.pkl", as_bytes(bytes), allowed); }

std::string refusal(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Pickle, ReadsEveryKindOfValue) {
  PickleFixture fixture;
  fixture.op("}(");
  fixture.text("none").op("N");
  fixture.text("yes").op("\x88").text("no").op("\x89");
  fixture.text("int").integer(-7).text("byte").op("K\xc8").text("short").op("M\x01\x02");
  fixture.text("long").op(std::string("\x8a\x05\x00\x00\x00\x00\xff", 7));
  fixture.text("zero").op(std::string("\x8a\x00", 2));
  fixture.text("real").real(-0.375);
  fixture.text("list").op("](").integer(1).integer(2).op("e").integer(3).op("a");
  fixture.text("tuples").op(")").integer(1).op("\x86\x85").integer(3).integer(4).op("\x87");
  fixture.text("ordered").global("collections", "OrderedDict").op(")R");
  fixture.text("key").integer(9).op("s");
  fixture.text("stored").text("id").op("Q");
  fixture.text("built").global("torch", "FloatStorage").integer(5).op("\x85R}b");
  fixture.op("u");
  const Pickle pickle = read(fixture.done());
  const Pickle::Value& root = pickle[pickle.root()];
  const auto at = [&](std::string_view key) -> const Pickle::Value& {
    const Pickle::Value* value = pickle.find(root, key);
    if (!value) throw std::runtime_error("no " + std::string(key));
    return *value;
  };
  EXPECT_EQ(at("none").kind, Kind::none);
  EXPECT_EQ(at("yes").kind, Kind::boolean);
  EXPECT_EQ(at("yes").integer, 1);
  EXPECT_EQ(at("no").integer, 0);
  EXPECT_EQ(at("int").integer, -7);
  EXPECT_EQ(at("byte").integer, 200);
  EXPECT_EQ(at("short").integer, 0x201);
  EXPECT_EQ(at("long").integer, -(std::int64_t(1) << 32));
  EXPECT_EQ(at("zero").integer, 0);
  EXPECT_EQ(at("real").real, -0.375);
  ASSERT_EQ(at("list").items.size(), 3u);
  EXPECT_EQ(pickle[at("list").items[2]].integer, 3);
  ASSERT_EQ(at("tuples").items.size(), 3u);
  EXPECT_EQ(pickle[at("tuples").items[0]].items.size(), 1u);
  EXPECT_EQ(pickle[pickle[at("tuples").items[0]].items[0]].items.size(), 2u);
  EXPECT_EQ(pickle.find(at("ordered"), "key")->integer, 9);
  EXPECT_EQ(at("stored").kind, Kind::persistent);
  EXPECT_EQ(at("built").kind, Kind::constructed);
  EXPECT_EQ(pickle[at("built").items[0]].text, "torch.FloatStorage");
  EXPECT_EQ(pickle.find(root, "absent"), nullptr);
}

TEST(Pickle, TheMemoSharesValuesAndAllowsCycles) {
  // A list that contains itself twice, by both sizes of memo opcode.
  const Pickle pickle = read(PickleFixture()
                                 .op("]q")
                                 .op(std::string(1, '\0'))
                                 .op("h")
                                 .op(std::string(1, '\0'))
                                 .op("a")
                                 .op("r")
                                 .op(std::string("\x2c\x01\0\0", 4))
                                 .op("j")
                                 .op(std::string("\x2c\x01\0\0", 4))
                                 .op("a")
                                 .done());
  const Pickle::Value& root = pickle[pickle.root()];
  ASSERT_EQ(root.items.size(), 2u);
  EXPECT_EQ(root.items[0], pickle.root());
  EXPECT_EQ(root.items[1], pickle.root());
}

TEST(Pickle, DepthIsNoDanger) {
  PickleFixture fixture;
  fixture.op("N");
  for (int i = 0; i < 1000000; ++i) fixture.op("\x85");
  const Pickle pickle = read(fixture.done());
  EXPECT_EQ(pickle[pickle.root()].items.size(), 1u);
}

// Row X4 of the catalogue of numerical hazards: opcodes and names are those of a list, nothing is
// executed. The third of it, zip bombs, is HostileBombs.X4_* (hostile_test.cpp).
TEST(Pickle, X4_EveryOtherOpcodeIsRefusedByNameAndByte) {
  const std::string known = "(.JKMNQRXabcehjqrstuG)]}\x85\x86\x87\x88\x89\x8a";
  int refused = 0;
  for (int opcode = 0; opcode < 256; ++opcode) {
    if (known.find(static_cast<char>(opcode)) != std::string::npos) continue;
    const std::string message =
        refusal(PickleFixture().op("N").op(std::string(1, static_cast<char>(opcode))).done());
    char code[8];
    std::snprintf(code, sizeof code, "(0x%02x)", opcode);
    EXPECT_THAT(message, HasSubstr(code));
    EXPECT_THAT(message, HasSubstr("data.pkl: byte 3: the pickle opcode "));
    EXPECT_THAT(message, HasSubstr("nothing was executed"));
    ++refused;
  }
  EXPECT_EQ(refused, 256 - 30);
  EXPECT_THAT(refusal("\x80\x02"
                      "ios\nsystem\n."),
              HasSubstr("opcode INST (0x69)"));
  EXPECT_THAT(refusal("\x80\x02\x93."), HasSubstr("opcode STACK_GLOBAL (0x93)"));
  EXPECT_THAT(refusal("\x80\x02N\x81."), HasSubstr("opcode NEWOBJ (0x81)"));
  EXPECT_THAT(refusal(std::string("\x80\x04\x95", 3)), HasSubstr("opcode FRAME (0x95)"));
}

TEST(Pickle, X4_EveryOtherGlobalIsRefusedByNameAndNothingIsExecuted) {
  const auto calling = [](std::string_view module, std::string_view name) {
    return PickleFixture().global(module, name).text("true").op("\x85R").done();
  };
  EXPECT_THAT(refusal(calling("posix", "system")),
              HasSubstr("byte 2: the pickle wants the global posix.system"));
  EXPECT_EQ(refusal(calling("os", "system")),
            "data.pkl: byte 2: the pickle wants the global os.system, which is not on the list of "
            "harmless ones: refused, nothing was executed");
  EXPECT_THAT(refusal(calling("builtins", "eval")), HasSubstr("global builtins.eval"));
  EXPECT_THAT(refusal(calling("torch", "load")), HasSubstr("global torch.load"));
  EXPECT_THAT(refusal(calling("torch.FloatStorage", "x")), HasSubstr("torch.FloatStorage.x"));
  // A name from the file cannot write to a terminal through the message.
  EXPECT_THAT(refusal(calling("evil\x1b[2J", "x")), HasSubstr("evil\\u001b[2J.x"));
}

TEST(Pickle, NonsenseIsRefused) {
  EXPECT_THAT(refusal("abc"), HasSubstr("not a pickle of protocol 2"));
  EXPECT_THAT(refusal("\x80\x01."), HasSubstr("protocol 1"));
  EXPECT_THAT(refusal("\x80\x02."), HasSubstr("ends with 0 values"));
  EXPECT_THAT(refusal("\x80\x02NN."), HasSubstr("ends with 2 values"));
  EXPECT_THAT(refusal("\x80\x02t."), HasSubstr("a mark that is not there"));
  EXPECT_THAT(refusal("\x80\x02N(\x85."), HasSubstr("takes a value that is not there"));
  EXPECT_THAT(refusal("\x80\x02NNa."), HasSubstr("adds items to None"));
  EXPECT_THAT(refusal("\x80\x02}(Nu."), HasSubstr("a key without a value"));
  EXPECT_THAT(refusal("\x80\x02NNR."), HasSubstr("REDUCE of None with None"));
  EXPECT_THAT(refusal("\x80\x02h\x05."), HasSubstr("memo 5, which was never set"));
  EXPECT_THAT(refusal("\x80\x02Nr\xff\xff\xff\xff."),
              HasSubstr("memo 4294967295 is out of bounds"));
  EXPECT_THAT(refusal("\x80\x02\x8a\x09."), HasSubstr("LONG1 of 9 bytes"));
  EXPECT_THAT(refusal("\x80\x02X\xff\xff\xff\xff."), HasSubstr("ends within a text"));
  EXPECT_THAT(refusal("\x80\x02"
                      "cposix"),
              HasSubstr("ends within a module's name"));
}

TEST(Pickle, MemoryIsBounded) {
  EXPECT_THAT(refusal("\x80\x02" + std::string(Pickle::max_values + 1, 'N')), HasSubstr("over "));
  EXPECT_THAT(refusal(std::string(Pickle::max_bytes + 1, 'N')), HasSubstr("the limit is"));
}

}  // namespace
}  // namespace tureen
