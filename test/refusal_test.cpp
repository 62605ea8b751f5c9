// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/refusal.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "test/support/random.h"

namespace hgrid {
namespace {

TEST(Refusal, ItsCodesAreThoseOfTheMessage) {
  std::ifstream file(HGRID_PROJECT_DIR "/msg/CodeNames.msg");
  ASSERT_TRUE(file) << "msg/CodeNames.msg cannot be opened";
  int seen = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string type, word, equals;
    int number = -1;
    if (!(words >> type >> word >> equals >> number) || type != "uint16" || equals != "=") continue;
    EXPECT_EQ(name(static_cast<Code>(number)), word);
    EXPECT_EQ(number, seen++);
  }
  EXPECT_EQ(seen, int(Code::failed) + 1);
}

TEST(Text, IsShortAndReadsBackAsTheSameNumber) {
  EXPECT_EQ(text(0.05), "0.05");
  EXPECT_EQ(text(0.1), "0.1");
  EXPECT_EQ(text(1.0), "1");
  EXPECT_EQ(text(-2.5), "-2.5");
  EXPECT_EQ(text(1e-320), "1e-320");
  EXPECT_EQ(text(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(text(-std::numeric_limits<double>::quiet_NaN()), "nan");  // the sign of a NaN depends on the processor
  EXPECT_EQ(text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(text(-std::numeric_limits<double>::infinity()), "-inf");
  test::Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const double value = random.logUniform(1e-300, 1e300) * (random.chance(0.5) ? 1 : -1);
    ASSERT_EQ(std::strtod(text(value).c_str(), nullptr), value);
  }
}

TEST(Text, OfALengthIsRoundedToMicrometers) {
  EXPECT_EQ(metersText(0.25), "0.25 m");
  EXPECT_EQ(metersText(0.12345678), "0.123457 m");
  EXPECT_EQ(metersText(0.0), "0 m");
}

TEST(Text, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, locale);
  EXPECT_EQ(text(0.05), "0.05");
  EXPECT_EQ(text(1234567.5), "1234567.5");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Printable, KeepsTextAndEscapesTheRest) {
  EXPECT_EQ(printable("robot/tool0"), "robot/tool0");
  EXPECT_EQ(printable("größe/日本"), "größe/日本");
  EXPECT_EQ(printable("a\nb"), "a\\x0ab");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x1b[31m"), "\\x1b[31m");
  EXPECT_EQ(printable("\xff\xc0\x80"), "\\xff\\xc0\\x80");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");  // the first two bytes of a character of three bytes
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, CutsWhatIsTooLong) {
  EXPECT_EQ(printable(std::string(128, 'a')), std::string(128, 'a'));
  EXPECT_EQ(printable(std::string(129, 'a')), std::string(128, 'a') + "…");
  EXPECT_EQ(printable("abcdef", 3), "abc…");
  EXPECT_LE(printable(std::string(1000000, '\n')).size(), 140u);
}

}  // namespace
}  // namespace hgrid
