#include "engine/core/text.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "tests/scene/sample.h"

namespace plumb {
namespace {

using Limits = std::numeric_limits<double>;

TEST(Shortest, Examples) {
  EXPECT_EQ(shortest(0), "0");
  EXPECT_EQ(shortest(-0.0), "-0.0");
  EXPECT_EQ(shortest(1), "1");
  EXPECT_EQ(shortest(-9.81), "-9.81");
  EXPECT_EQ(shortest(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(shortest(5e-324), "5e-324");
  EXPECT_EQ(shortest(1e100), "1e+100");
  EXPECT_EQ(shortest(Limits::max()), "1.7976931348623157e+308");
  EXPECT_EQ(shortest(Limits::quiet_NaN()), "nan");
  EXPECT_EQ(shortest(-Limits::infinity()), "-inf");
}

/// C's own reader gives the bits back, and C's own printer finds no decimal with a digit less that does.
TEST(Shortest, RoundTripsAndIsShortest) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double value = test::random_bits(random);
    const std::string text = shortest(value);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << text;
    int digits = 0;
    for (const char c : text.substr(0, text.find('e'))) digits += c >= '0' && c <= '9' ? 1 : 0;
    if (digits < 2 || text.find('e') == std::string::npos) continue;
    std::array<char, 64> shorter{};
    std::snprintf(shorter.data(), shorter.size(), "%.*e", digits - 2, value);
    ASSERT_NE(std::strtod(shorter.data(), nullptr), value) << text << " " << shorter.data();
  }
}

TEST(Utf8, LengthsOfCharacters) {
  EXPECT_EQ(utf8_length("a"), 1u);
  EXPECT_EQ(utf8_length("\xC2\x80"), 2u);
  EXPECT_EQ(utf8_length("\xE0\xA0\x80"), 3u);
  EXPECT_EQ(utf8_length("\xED\x9F\xBF"), 3u);
  EXPECT_EQ(utf8_length("\xF0\x90\x80\x80"), 4u);
  EXPECT_EQ(utf8_length("\xF4\x8F\xBF\xBF"), 4u);
}

TEST(Utf8, RefusesWhatTheUnicodeStandardDoes) {
  for (const char* text : {"", "\x80", "\xC1\xBF", "\xC2", "\xC2 ", "\xE0\x9F\xBF", "\xED\xA0\x80",
                           "\xE2\x82", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    EXPECT_EQ(utf8_length(text), 0u) << printable(text);
  }
  EXPECT_TRUE(is_utf8("Körper 球 \xF0\x9F\x8F\x80"));
  EXPECT_FALSE(is_utf8("K\xF6rper"));
}

TEST(Utf8, ControlCharacters) {
  using namespace std::string_view_literals;
  for (const std::string_view text : {"a\0b"sv, "\x1F"sv, "\x7F"sv, "a\xC2\x80"sv, "\xC2\x9F"sv}) {
    EXPECT_TRUE(has_control_character(text)) << printable(text);
  }
  for (const char* text : {"", " ", "~", "\xC2\xA0", "Körper"})
    EXPECT_FALSE(has_control_character(text)) << text;
}

TEST(Printable, HidesNothingAndStaysShort) {
  EXPECT_EQ(printable("a\nb\x7F\xFFé\xC2\x85"), "a\\x0ab\\x7f\\xffé\\xc2\\x85");
  EXPECT_EQ(printable("abcdef", 4), "abcd...");
  EXPECT_EQ(printable("abcé", 4), "abc...");  // never half a character
  EXPECT_EQ(quoted("it's"), "'it's'");
}

}  // namespace
TEST(Text, MeasuresTheDecimalAtTheStart) {
  EXPECT_EQ(decimal_length("2.5e-3*x"), 6U);
  EXPECT_EQ(decimal_length(".5)"), 2U);
  EXPECT_EQ(decimal_length("1."), 2U);
  EXPECT_EQ(decimal_length("3e"), 1U);  // a name may follow
  EXPECT_EQ(decimal_length("3e+x"), 1U);
  EXPECT_EQ(decimal_length("0x1p3"), 1U);  // no hexadecimal numbers
  EXPECT_EQ(decimal_length("."), 0U);
  EXPECT_EQ(decimal_length("-1"), 0U);
  EXPECT_EQ(decimal_length("inf"), 0U);
}

// The bits: 2^-1 + 2^-54 lies halfway and is rounded to even; the largest double, the least, and those
// beyond.
TEST(Text, ReadsDecimalsToTheNearestDouble) {
  EXPECT_EQ(read_decimal("0.500000000000000055511151231257827021181583404541015625"), 0.5);
  EXPECT_EQ(read_decimal("0.50000000000000005551115123125782702118158340454101562500001"),
            0x1.0000000000001p-1);
  EXPECT_EQ(read_decimal("0.1"), 0x1.999999999999ap-4);
  EXPECT_EQ(read_decimal("1.7976931348623157e308"), 0x1.fffffffffffffp1023);
  EXPECT_EQ(read_decimal("5e-324"), 0x1p-1074);
  EXPECT_EQ(read_decimal("0e999"), 0.0);
  EXPECT_EQ(read_decimal("1e309"), std::nullopt);
  EXPECT_EQ(read_decimal("1e-400"), std::nullopt);
}

}  // namespace plumb
