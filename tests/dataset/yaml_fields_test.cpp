// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yaml_fields.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

NamedFields Parse(const std::string& text) { return YamlFields(text, "a.yaml"); }

TEST(YamlFieldsTest, MapsAndListsOfBothStyles) {
  EXPECT_THAT(
      Parse("%YAML:1.0\n---\n# a comment\nwidth: 640 # pixels\nmatrix: !!opencv-matrix\n"
            "   rows: 2\n   data: [ 1., 2.,\n       3., 4. ]\nempty:\n"
            "names:\n  - 'a: b'\n  - \"c # d\"\nK:\n- 1\n- 2\nmap: {x: [1, 2], 'y': z}\n"),
      ElementsAre(Pair("K", ElementsAre("1", "2")), Pair("map.x", ElementsAre("1", "2")),
                  Pair("map.y", ElementsAre("z")),
                  Pair("matrix.data", ElementsAre("1.", "2.", "3.", "4.")),
                  Pair("matrix.rows", ElementsAre("2")),
                  Pair("names", ElementsAre("a: b", "c # d")), Pair("width", ElementsAre("640"))));
}

TEST(YamlFieldsTest, NestedMapsEndWithTheirIndentation) {
  EXPECT_THAT(Parse("a:\n  b:\n    c: 1\n  d: 2\ne: 3\n"),
              ElementsAre(Pair("a.b.c", ElementsAre("1")), Pair("a.d", ElementsAre("2")),
                          Pair("e", ElementsAre("3"))));
}

TEST(YamlFieldsTest, BlocksOfTextAndFurtherDocumentsAreLeftOut) {
  EXPECT_THAT(Parse("download: |\n  import os\n\n  x = [1\nnames: [a]\n---\nnames: [b]\n"),
              ElementsAre(Pair("names", ElementsAre("a"))));
  EXPECT_THAT(Parse("list: []\n"), ElementsAre(Pair("list", IsEmpty())));
}

TEST(YamlFieldsTest, WhatIsNotReadIsNamed) {
  const auto refused = [](const std::string& text, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Parse(text); }, words);
  };
  refused("a: 1\nwhat\n", {"a.yaml:2", "'what'", "key: value"});
  refused("a: 1\na: 2\n", {"a.yaml:2", "key a twice"});
  refused("a: [1, 2\nb: 3\n", {"not closed"});
  refused("- 1\n", {"a.yaml:1", "no list"});
  refused("a:\n  - b: 1\n", {"a.yaml:2", "list of maps"});
  refused("a: &anchor\n", {"a.yaml:1", "anchor"});
  refused("a:\n\tb: 1\n", {"a.yaml:2", "tab"});
  std::string deep;
  for (int i = 0; i < 30; ++i) deep += std::string(static_cast<size_t>(i), ' ') + "a:\n";
  refused(deep, {"nested too deep"});
  refused("a: " + std::string(50, '[') + std::string(50, ']'), {"nested too deep"});
  std::string many = "a: [1";
  for (int i = 0; i < 100000; ++i) many += ",1";
  refused(many + "]", {"more than 100000 values"});
  refused("a:\n  " + std::string(200, 'b') + ": 1\n",
          {"a.yaml:2", "201 characters", "at most 200"});
  refused("a: {b: {" + std::string(250, 'c') + ": 1}}\n",
          {"characters, with those around it; expected at most 200"});
  std::string keys;
  for (int i = 0; i <= 100000; ++i) keys += fmt::format("k{}:\n", i);
  refused(keys, {"more than 100000 keys"});
  refused(std::string(4000001, '\n'), {"more than 4000000 lines"});
}

class XmlFieldsTest : public testing::Test {
 protected:
  NamedFields Read(const std::string& text) {
    WriteBytes(folder_ / "a.xml", text);
    return ReadXmlFields(folder_ / "a.xml");
  }
  TemporaryFolder folder_;
};

TEST_F(XmlFieldsTest, WordsByElement) {
  EXPECT_THAT(Read("<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- <no> --><width>640</width>\n"
                   "<m type_id=\"opencv-matrix\"><rows>1</rows><data>\n 1. 2.\n 3.</data></m>"
                   "<none/></opencv_storage>\n"),
              ElementsAre(Pair("m", IsEmpty()), Pair("m.data", ElementsAre("1.", "2.", "3.")),
                          Pair("m.rows", ElementsAre("1")), Pair("none", IsEmpty()),
                          Pair("width", ElementsAre("640"))));
}

TEST_F(XmlFieldsTest, BadFilesAreNamed) {
  const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Read(text); }, words);
  };
  refused("", {"a.xml", "no elements"});
  refused("<a><b>1</b>", {"a.xml", "<a> that is not closed"});
  refused("<a><b>1</c></a>", {"</c> of nothing"});
  refused("</a>", {"</a> of nothing"});
  refused("<a><b>1</b><b>2</b></a>", {"<b> twice"});
  refused("<a", {"< without >"});
  std::string deep;
  for (int i = 0; i < 30; ++i) deep += "<a>";
  refused(deep, {"nested too deep"});
  refused("<a><" + std::string(201, 'b') + ">", {"more than 200 characters"});
  refused("<a><" + std::string(150, 'b') + "><" + std::string(50, 'c') + ">", {"200 characters"});
  std::string many = "<a>";
  for (int i = 0; i < 100000; ++i) many += fmt::format("<b{}/>", i);
  refused(many, {"more than 100000 elements"});
}

}  // namespace
}  // namespace soslam
