#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <random>

#include "engine/scene/json.h"
#include "engine/scene/json/json_document.h"
#include "tests/scene/sample.h"

namespace plumb {
namespace {

using Kind = Error::Kind;
using namespace std::string_view_literals;

struct Bad {
  std::string_view text;
  int line;
  std::string_view problem;  ///< a part of the text
};

TEST(BadInput, SaysWhereAndWhatWasExpected) {
  const Bad cases[] = {
      {"", 1, "is empty"},
      {" \n\t\r\n ", 1, "is empty"},
      {"{", 1, "unexpected end of input; expected string literal"},
      {"{\n\"bodies\": [\n", 2, "unexpected end of input"},
      {"{\n\"name\": \"a\"\n\"gravity\": [0, 0]}", 3, "unexpected string literal; expected ',' or '}'"},
      {"{\"gravity\":\n[0\n1]}", 3, "unexpected number literal; expected ',' or ']'"},
      {"{\"name\"\n\n\"a\"}", 3, "expected ':'"},
      {"{\"name\": \"a\",\n}", 2, "unexpected '}'; expected string literal"},
      {"{'name': \"a\"}", 1, "invalid literal"},
      {"{\"name\": a}", 1, "invalid literal"},
      {"{\"gravity\": [NaN, 0]}", 1, "invalid literal"},
      {"{\"gravity\": [+1, 0]}", 1, "invalid literal"},
      {"{\"gravity\": [01, 0]}", 1, "expected ',' or ']'"},
      {"{\"gravity\": [1., 0]}", 1, "invalid number"},
      {"{\"gravity\": [-, 0]}", 1, "invalid number"},
      {"{\"gravity\": [0x10, 0]}", 1, "invalid literal"},
      {"{\n// comment\n}", 2, "invalid literal"},
      {"{\"name\": \"a\nb\"}", 1, "must be escaped"},
      {"{\"name\": \"\\q\"}", 1, "invalid string"},
      {"{\"name\": \"\\ud800\"}", 1, "surrogate"},
      {"{\"name\": \"never closed}", 1, "missing closing quote"},
      {"{\n\"name\": \"\xFF\"}", 2, "ill-formed UTF-8"},
      {"{\"name\": \"\xC0\x80\"}", 1, "ill-formed UTF-8"},
      {"{\"name\": \"\xED\xA0\x80\"}", 1, "ill-formed UTF-8"},
      {"{}\n{}", 2, "expected end of input"},
      {"{}\nx", 2, "expected end of input"},
      {"{}\n\0"sv, 2, "zero byte"},
      {"{\"name\": \"a\0b\"}"sv, 1, "zero byte"},
      {"\xEF\xBB\xBF{}", 1, "byte order mark"},
      {"\xFF\xFE{\0}\0"sv, 1, "UTF-16"},
      {"\xFE\xFF\0{\0}"sv, 1, "UTF-16"},
      {"[]", 1, "must be an object"},
      {"null", 1, "must be an object"},
      {"\"scene\"", 1, "must be an object"},
      {"-0", 1, "must be an object"},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.text);
    const Error error = test::error_of([&] { scene_from_json(bad.text); });
    EXPECT_EQ(error.kind(), Kind::Syntax);
    EXPECT_EQ(error.line(), bad.line) << error.what();
    EXPECT_EQ(error.subject(), "scene");
    EXPECT_NE(error.problem().find(bad.problem), std::string::npos) << error.what();
  }
}

std::string repeated(std::string_view piece, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += piece;
  return out;
}

TEST(BadInput, DeepNestingIsRefused) {
  for (const char* piece : {"[", "{\"bodies\":", "{\"bodies\":[", "[\n"}) {
    const std::string text = repeated(piece, 100000);
    const Error error = test::error_of([&] { scene_from_json(text); });
    EXPECT_EQ(error.kind(), Kind::Syntax);
    EXPECT_NE(error.problem().find("deeper than 64"), std::string::npos) << error.what();
  }
  const Error error =
      test::error_of([] { scene_from_json("{\"name\":" + repeated("[", 63) + repeated("]", 63) + "}"); });
  EXPECT_EQ(error.field(), "name");
}

TEST(BadInput, TooLongATextIsRefusedUnread) {
  const std::size_t size = json::kMaxTextSize + 1;
  const std::unique_ptr<void, decltype(&std::free)> memory(std::calloc(size, 1), &std::free);
  ASSERT_NE(memory, nullptr);
  const std::string_view text(static_cast<const char*>(memory.get()), size);
  EXPECT_NE(test::error_of([&] { scene_from_json(text); }).problem().find("too long"), std::string::npos);
}

TEST(BadInput, ManyKeysAndValuesAreRefusedInGoodTime) {
  std::string keys = "{", values = "[0";
  for (int i = 0; i < 200000; ++i) {
    keys += "\"k" + std::to_string(i) + "\":0,";
    values += ",0";
  }
  EXPECT_EQ(test::error_of([&] { scene_from_json(keys + "\"k7\":0}"); }).field(), "k7");
  EXPECT_EQ(test::error_of([&] { scene_from_json(keys + "\"z\":0}"); }).field(), "k0");
  EXPECT_EQ(test::error_of([&] { scene_from_json("{\"gravity\":" + values + "]}"); }).field(), "gravity");
  const std::string name(10000000, '"');
  EXPECT_EQ(test::error_of([&] { scene_from_json("{\"name\":\"" + name); }).kind(), Kind::Syntax);
}

TEST(BadInput, EveryTruncationIsRefused) {
  for (const int indent : {-1, 2}) {
    const std::string text = to_json(test::full_scene(), indent);
    EXPECT_NO_THROW(scene_from_json(text));
    for (std::size_t size = 0; size < text.size(); ++size) {
      const Error error = test::error_of([&] { scene_from_json(std::string_view(text).substr(0, size)); });
      ASSERT_EQ(error.kind(), Kind::Syntax) << size << " " << error.what();
      ASSERT_GE(error.line(), 1);
    }
  }
}

/// Whatever the text, it is either refused with an `Error` or read as a scene that survives its own round
/// trip.
void read_or_refuse(const std::string& text, int& accepted) {
  try {
    const Scene scene = scene_from_json(text);
    ASSERT_TRUE(test::same_bits(scene_from_json(to_json(scene)), scene)) << text;
    ++accepted;
  } catch (const Error& error) {
    ASSERT_GE(error.line(), 1) << error.what() << "\n" << text;
    ASSERT_FALSE(error.problem().empty());
    ASSERT_FALSE(error.subject().empty());
  }
}

TEST(BadInput, RandomBytesAreReadOrRefused) {
  std::mt19937_64 random(7);
  const std::string whole = to_json(test::full_scene());
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = whole;
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n)
      text[random() % text.size()] = static_cast<char>(random());
    ASSERT_NO_FATAL_FAILURE(read_or_refuse(text, accepted));
  }
  EXPECT_GT(accepted, 50);  // digits that became other digits
}

TEST(BadInput, RandomPiecesOfJsonAreReadOrRefused) {
  static const std::string kPieces[] = {"{",        "}",          "[",     "]",           ",",        ":",
                                        "\"name\"", "\"bodies\"", "\"a\"", "-0",          "1e5",      "true",
                                        "null",     "\"type\"",   "\n",    "\"\\u00e9\"", "\"mass\"", "1"};
  std::mt19937_64 random(8);
  const std::string whole = to_json(test::full_scene());
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = whole;
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
      const std::size_t at = random() % text.size();
      text.replace(at, random() % 12, kPieces[random() % std::size(kPieces)]);
    }
    ASSERT_NO_FATAL_FAILURE(read_or_refuse(text, accepted));
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace plumb
