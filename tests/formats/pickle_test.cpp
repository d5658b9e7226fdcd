#include "formats/torch/pickle.hpp"

#include <gmock/gmock.h>

#include "tests/formats/format_testing.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace pickle_test {

using test::as_bytes;
using test::error_of;
using test::ErrorAt;
using test::PickleFixture;
using test::Refusal;
using Kind = Pickle::Kind;

constexpr std::string_view allowed[] = {"torch.FloatStorage"};

Pickle read(const std::string& bytes) { return Pickle("data.pkl", as_bytes(bytes), allowed); }

std::optional<Refusal> refusal(const std::string& bytes) {
  return error_of([&] { read(bytes); });
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
  // A list that contains itself twice, with both sizes of memo opcode.
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

// Row X4 of the catalogue of numerical hazards: only listed opcodes and names are accepted, and
// nothing is executed. Its third part, zip bombs, is HostileBombs.X4_* (hostile_test.cpp).
TEST(Pickle, X4_EveryOtherOpcodeIsRefusedByNameAndByte) {
  const std::string known = "(.JKMNQRXabcehjqrstuG)]}\x85\x86\x87\x88\x89\x8a";
  int refused = 0;
  for (int opcode = 0; opcode < 256; ++opcode) {
    if (known.find(static_cast<char>(opcode)) != std::string::npos) continue;
    const auto message =
        refusal(PickleFixture().op("N").op(std::string(1, static_cast<char>(opcode))).done());
    char code[8];
    std::snprintf(code, sizeof code, "(0x%02x)", opcode);
    EXPECT_THAT(message, ErrorAt("data.pkl@3", code));
    ++refused;
  }
  EXPECT_EQ(refused, 256 - 30);
  EXPECT_THAT(refusal("\x80\x02"
                      "ios\nsystem\n."),
              ErrorAt("data.pkl@2", "INST", "0x69"));
  EXPECT_THAT(refusal("\x80\x02\x93."), ErrorAt("data.pkl@2", "STACK_GLOBAL", "0x93"));
  EXPECT_THAT(refusal("\x80\x02N\x81."), ErrorAt("data.pkl@3", "NEWOBJ", "0x81"));
  EXPECT_THAT(refusal(std::string("\x80\x04\x95", 3)), ErrorAt("data.pkl@2", "FRAME", "0x95"));
}

TEST(Pickle, X4_EveryOtherGlobalIsRefusedByNameAndNothingIsExecuted) {
  const auto calling = [](std::string_view module, std::string_view name) {
    return PickleFixture().global(module, name).text("true").op("\x85R").done();
  };
  EXPECT_THAT(refusal(calling("posix", "system")), ErrorAt("data.pkl@2", "posix.system"));
  EXPECT_THAT(refusal(calling("os", "system")), ErrorAt("data.pkl@2", "os.system"));
  EXPECT_THAT(refusal(calling("builtins", "eval")), ErrorAt("data.pkl@2", "builtins.eval"));
  EXPECT_THAT(refusal(calling("torch", "load")), ErrorAt("data.pkl@2", "torch.load"));
  EXPECT_THAT(refusal(calling("torch.FloatStorage", "x")),
              ErrorAt("data.pkl@2", "torch.FloatStorage.x"));
  // A name from the file cannot send control codes to a terminal through the message.
  EXPECT_THAT(refusal(calling("evil\x1b[2J", "x")), ErrorAt("data.pkl@2", "evil\\u001b[2J.x"));
}

TEST(Pickle, NonsenseIsRefused) {
  EXPECT_THAT(refusal("abc"), ErrorAt("data.pkl@0", 2));
  EXPECT_THAT(refusal("\x80\x01."), ErrorAt("data.pkl@0", 1));
  EXPECT_THAT(refusal("\x80\x02."), ErrorAt("data.pkl@2", 0));
  EXPECT_THAT(refusal("\x80\x02NN."), ErrorAt("data.pkl@4", 2));
  EXPECT_THAT(refusal("\x80\x02t."), ErrorAt("data.pkl@2"));
  EXPECT_THAT(refusal("\x80\x02N(\x85."), ErrorAt("data.pkl@4"));
  EXPECT_THAT(refusal("\x80\x02NNa."), ErrorAt("data.pkl@4", "None"));
  EXPECT_THAT(refusal("\x80\x02}(Nu."), ErrorAt("data.pkl@5"));
  EXPECT_THAT(refusal("\x80\x02NNR."), ErrorAt("data.pkl@4", "REDUCE", "None"));
  EXPECT_THAT(refusal("\x80\x02h\x05."), ErrorAt("data.pkl@2", 5));
  EXPECT_THAT(refusal("\x80\x02Nr\xff\xff\xff\xff."), ErrorAt("data.pkl@3", "4294967295"));
  EXPECT_THAT(refusal("\x80\x02\x8a\x09."), ErrorAt("data.pkl@2", "LONG1", 9));
  EXPECT_THAT(refusal("\x80\x02X\xff\xff\xff\xff."), ErrorAt("data.pkl@2"));
  EXPECT_THAT(refusal("\x80\x02"
                      "cposix"),
              ErrorAt("data.pkl@2"));
}

TEST(Pickle, MemoryIsBounded) {
  EXPECT_THAT(refusal("\x80\x02" + std::string(Pickle::max_values + 1, 'N')),
              ErrorAt("data.pkl@2097154"));
  EXPECT_THAT(refusal(std::string(Pickle::max_bytes + 1, 'N')), ErrorAt("data.pkl"));
}

}  // namespace pickle_test
}  // namespace tureen
