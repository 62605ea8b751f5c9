// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Texts that the reader refuses before the XML library reads them, and similar texts that it must accept.
#include <gtest/gtest.h>

#include "test/adapters/urdf_texts.h"
#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

std::string nested(int count, const std::string& open = "<a>", const std::string& close = "</a>") {
  std::string text;
  for (int i = 0; i < count; ++i) text += open;
  for (int i = 0; i < count; ++i) text += close;
  return text;
}

TEST(UrdfText, EmptyTextIsRefused) {
  for (const char* text : {"", " ", "\n\t\n"})
    EXPECT_EQ(refusalOf([&] { read(text); }), Code::parse) << "'" << text << "'";
}

TEST(UrdfText, InvalidXmlIsRefusedWithTheLine) {
  const std::string whole = robot(link("a", collision("<sphere radius=\"1\"/>")));
  const std::vector<std::string> texts = {"hello",
                                          "<robot",
                                          "<robot name=\"r\">\n<link name=\"a\">\n</robot>\n",
                                          "<robot name=\"r\">\n<link name=a/>\n</robot>",
                                          whole.substr(0, whole.size() / 2),
                                          whole.substr(0, whole.size() - 3)};
  for (const std::string& text : texts) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { read(text); }, &sentence), Code::parse) << text;
    EXPECT_TRUE(says(sentence, "line")) << text;
  }
}

TEST(UrdfText, EveryTruncationIsRefused) {
  std::string whole = robot(link("a", collision("<sphere radius=\"1\"/>")) + link("b") + joint("j", "a", "b"));
  whole.pop_back();  // a text without the final line break is still complete
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    EXPECT_EQ(refusalOf([&] { read(whole.substr(0, bytes)); }), Code::parse) << bytes << " bytes";
  }
  EXPECT_EQ(read(whole).links.size(), 2u);
}

TEST(UrdfText, BinaryIsRefused) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    std::string bytes(static_cast<std::size_t>(1 + random.below(1000)), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(256));
    EXPECT_NE(refusalOf([&] { read(bytes); }), Code::ok) << i;
  }
  EXPECT_EQ(refusalOf([] { read(std::string(1000, '\0')); }), Code::parse);
  const std::string good = robot(link("a"));
  EXPECT_EQ(refusalOf([&] { read(good.substr(0, 20) + std::string(1, '\0') + good.substr(20)); }), Code::parse);
}

TEST(UrdfText, AnotherRootIsRefused) {
  EXPECT_EQ(refusalOf([] { read("<sdf version=\"1.6\"><model name=\"m\"/></sdf>"); }), Code::parse);
}

TEST(UrdfText, FiftyThousandLevelsAreRefusedAtTheLimit) {
  const std::vector<std::string> deep = {
      nested(50000),           nested(50000, "<a b=\"/>\">"),     nested(50000, "<a b='>' c=\"'/>\">"),
      nested(50000, "<a\n>"),  nested(50000, "<!-- </a> --><a>"), nested(50000, "<![CDATA[</a>]]><a>"),
      nested(50000, "<a>", "")};
  for (const std::string& text : deep) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { read(robot(text)); }, &sentence), Code::limit) << text.substr(0, 60);
    EXPECT_TRUE(says(sentence, "at most 98 are allowed")) << text.substr(0, 60);
  }
}

/// Claim: what the parser of some Debian takes and that of another does not is refused on all, with the true reason.
TEST(UrdfText, WhatOnlySomeParsersTakeIsRefusedWithItsReason) {
  EXPECT_EQ(refusalOf([&] { read(robot(link("a") + nested(97))); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { read(robot(link("a") + nested(98))); }), Code::limit);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { read(robot("<?x y?>" + link("a"))); }, &sentence), Code::unsupported);
  EXPECT_TRUE(says(sentence, "processing instruction '<?x y?>"));
  EXPECT_EQ(refusalOf([&] { read("<?xml version=\"1.0\"?>" + robot(link("a"))); }), Code::ok);
}

TEST(UrdfText, TheDepthOfNestingIsTheLimitItself) {
  DescriptionLimits limits;
  limits.max_depth = 10;
  EXPECT_EQ(refusalOf([&] { checkXml(robot(nested(9)), limits, "text"); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { checkXml(robot(nested(10)), limits, "text"); }), Code::limit);
  EXPECT_EQ(refusalOf([&] { checkXml(robot(nested(9, "<a b='<a>'>")), limits, "text"); }), Code::ok);
}

TEST(UrdfText, OnlyOpenElementsCountAsDepth) {
  std::string flat;
  for (int i = 0; i < 2000; ++i) flat += "<a b=\"x\"/><a></a>";
  EXPECT_EQ(refusalOf([&] { checkXml(robot(flat), {}, "text"); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { checkXml(robot("<!-- " + nested(400, "<a>", "") + " -->"), {}, "text"); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { checkXml(robot("<![CDATA[" + nested(400, "<a>", "") + "]]>"), {}, "text"); }), Code::ok);
}

TEST(UrdfText, TextIsRefusedAboveItsLimitAndTakenAtIt) {
  const std::string model = robot(link("a"));
  const std::size_t limit = DescriptionLimits().max_bytes;
  ASSERT_EQ(limit, 16u << 20);
  EXPECT_EQ(read(model + std::string(limit - model.size(), ' ')).links.size(), 1u);
  EXPECT_EQ(refusalOf([&] { read(model + std::string(limit - model.size() + 1, ' ')); }), Code::limit);

  DescriptionLimits small;
  small.max_bytes = 20;
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { checkXml(std::string(21, ' '), small, "my_text"); }, &sentence), Code::limit);
  for (const char* word : {"20", "21", "my_text"}) EXPECT_TRUE(says(sentence, word));
}

TEST(UrdfText, ADocumentTypeIsRefused) {
  const std::string body = robot(link("a"));
  std::string laughs = "<!DOCTYPE robot [<!ENTITY a \"ha\">";
  for (char c = 'b'; c < 'z'; ++c) {
    const std::string last = std::string("&") + static_cast<char>(c - 1) + ";";
    laughs += std::string("<!ENTITY ") + c + " \"" + last + last + last + last + "\">";
  }
  const std::vector<std::string> texts = {
      "<!DOCTYPE robot>" + body, "<?xml version=\"1.0\"?>\n<!DOCTYPE robot SYSTEM \"http://127.0.0.1/r.dtd\">\n" + body,
      "<!DOCTYPE robot [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>" + robot(link("a&x;")),
      "<!-- one --><!DOCTYPE\trobot>" + body, laughs + "]>" + robot(link("&y;"))};
  for (const std::string& text : texts)
    EXPECT_EQ(refusalOf([&] { read(text); }), Code::unsupported) << text.substr(0, 80);
  EXPECT_EQ(read("<!-- <!DOCTYPE robot> -->" + body).links.size(), 1u) << "a document type in a comment is allowed";
}

TEST(UrdfText, MoreLinksThanTheLimitAreRefused) {
  DescriptionLimits limits;
  limits.max_links = 3;
  std::string three = link("l0");
  for (int i = 1; i < 3; ++i) {
    three += link("l" + std::to_string(i)) + joint("j" + std::to_string(i), "l0", "l" + std::to_string(i));
  }
  EXPECT_EQ(read(robot(three), limits).links.size(), 3u);
  std::string sentence;
  const std::string four = robot(three + link("l3") + joint("j3", "l0", "l3"));
  EXPECT_EQ(refusalOf([&] { read(four, limits); }, &sentence), Code::limit);
  for (const char* word : {"3", "4"}) EXPECT_TRUE(says(sentence, word));
}

TEST(UrdfText, LinksAndJointsAreCountedBeforeTheyAreRead) {
  DescriptionLimits limits;
  limits.max_links = 3;
  std::string links, joints = link("l0");
  for (int i = 0; i < 4; ++i) {
    links += link("same name");
    joints += joint("j" + std::to_string(i), "l0", "no such link");
  }
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { read(robot(links), limits); }, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "4 links"));
  EXPECT_EQ(refusalOf([&] { read(robot(joints), limits); }, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "4 joints"));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
