#include "reference/support/protocol.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "reference/support/serve.h"

namespace plumb::reference::protocol {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// A conversion of such a number to an int would have no defined result.
TEST(Protocol, WholeNumbersAreThoseThatAnIntHolds) {
  const auto read = [](const char* text) { return whole_number(parse_line(text), "n"); };
  EXPECT_EQ(read(R"({"n":2147483647})"), 2147483647);
  EXPECT_EQ(read(R"({"n":-3.0})"), -3);
  for (const char* text : {R"({"n":1e300})", R"({"n":2147483648})", R"({"n":-1e19})", R"({"n":0.5})",
                           R"({"n":"1"})", R"({"n":[1]})", R"({"n":null})", R"({"m":1})"})
    EXPECT_THROW(read(text), Malformed) << text;
}

std::string repeated(const char* piece, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += piece;
  return out;
}

// Copying and printing what is nested a million deep would use up the stack.
TEST(Protocol, LinesThatNestTooDeepAreRefused) {
  constexpr int kMany = 1'000'000;
  const std::string lines[] = {"{\"t\":0,\"states\":" + repeated("[", kMany) + repeated("]", kMany) + "}",
                               repeated("{\"a\":", kMany) + "1" + repeated("}", kMany), repeated("[", kMany)};
  for (const std::string& line : lines) {
    EXPECT_THAT([&] { parse_line(line); }, ThrowsMessage<Malformed>(HasSubstr("nests too deep")))
        << line.substr(0, 20);
  }
}

TEST(Protocol, BracketsInTextsAreNoNesting) {
  const std::string text = repeated("[", 1000) + "\\\"" + repeated("{", 1000);
  EXPECT_NO_THROW(parse_line("{\"a\":\"" + text + "\",\"b\":" + repeated("[", 60) + repeated("]", 60) + "}"));
}

// Steps that are none would be taken for ever.
TEST(Protocol, AServedEngineRefusesRunsOfNoSteps) {
  std::istringstream requests(
      "{\"request\":\"load\",\"scene\":{\"bodies\":[{\"name\":\"a\",\"inertia\":1}]},\"settings\":{\"dt\":0."
      "01}}\n"
      "{\"request\":\"run\",\"samples\":2000000000,\"every\":0}\n"
      "{\"request\":\"run\",\"samples\":-1,\"every\":1}\n");
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* answers = open_memstream(&text, &size);
  EXPECT_EQ(serve(find_backend("plumb-float"), requests, answers), 0);
  std::fclose(answers);
  std::istringstream lines(std::string(text, size));
  std::free(text);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_TRUE(parse_line(line).contains("effective_settings")) << line;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_THAT(line, HasSubstr("must ask for samples")) << i;
  }
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace plumb::reference::protocol
