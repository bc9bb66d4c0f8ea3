// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yaml_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"

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

TEST(YamlFieldsTest, FurtherDocumentsAreLeftOut) {
  EXPECT_THAT(Parse("names: [a]\nlist: []\n---\nnames: [b]\n"),
              ElementsAre(Pair("list", IsEmpty()), Pair("names", ElementsAre("a"))));
}

TEST(YamlFieldsTest, BlocksOfTextAndEmptyValues) {
  EXPECT_THAT(
      Parse("download: |\n  import os\n\n  x = [1\ntest:  # optional\nnames: [a, , c, ~]\n"),
      ElementsAre(Pair("download", ElementsAre("import os\n\nx = [1\n")),
                  Pair("names", ElementsAre("a", "", "c", ""))));
}

TEST(YamlFieldsTest, BadTextsAreNamed) {
  std::string deep, many = "a: [1", repeated = "a: &x " + std::string(1 << 18, 'y') + "\nb: [*x";
  for (int i = 0; i < 30; ++i) repeated += ",*x";
  for (int i = 0; i < 30; ++i) deep += std::string(static_cast<size_t>(i), ' ') + "a:\n";
  for (int i = 0; i < 100000; ++i) many += ",1";
  ExpectBadTexts(
      {{"a: 1\nwhat\nb: 2\n", {"a.yaml:3", "expected YAML: lines of key: value"}},
       {"a: 1\na: 2\n", {"a.yaml:2", "key a twice"}},
       {"a: [1, 2\nb: 3\n", {"a.yaml:"}},
       {"- 1\n", {"a.yaml:1", "no key: value"}},
       {deep, {"nested too deep"}},
       {"a: " + std::string(50, '[') + std::string(50, ']'), {"nested too deep"}},
       {many + "]", {"more than 100000 values"}},
       {repeated + "]", {"values of more than 1048576 bytes, those of aliases included"}},
       {"a:\n  " + std::string(200, 'b') + ": 1\n", {"a.yaml:2", "202 characters", "at most 200"}},
       {std::string(1 << 21, '\n'), {"2097152 bytes"}}},
      "a.yaml", &Parse);
}

NamedFields ParseXml(const std::string& text) { return XmlFields(text, "a.xml"); }

TEST(XmlFieldsTest, WordsByElement) {
  EXPECT_THAT(
      ParseXml("<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- <no> --><width>640</width>\n"
               "<m type_id=\"opencv-matrix\"><rows>1</rows><data>\n 1. 2.\n 3.</data></m>"
               "<none/></opencv_storage>\n"),
      ElementsAre(Pair("m", IsEmpty()), Pair("m.data", ElementsAre("1.", "2.", "3.")),
                  Pair("m.rows", ElementsAre("1")), Pair("none", IsEmpty()),
                  Pair("width", ElementsAre("640"))));
}

TEST(XmlFieldsTest, BadTextsAreNamed) {
  std::string deep;
  for (int i = 0; i < 30; ++i) deep += "<a>";
  ExpectBadTexts(
      {{"", {"no elements"}},
       {"<a><b>1</b>", {"<a> that is not closed"}},
       {"<a><b>1</c></a>", {"</c> of nothing"}},
       {"</a>", {"</a> of nothing"}},
       {"<a><b>1</b><b>2</b></a>", {"<b> twice"}},
       {"<a", {"< without >"}},
       {deep, {"nested too deep"}},
       {"<a><" + std::string(150, 'b') + "><" + std::string(50, 'c') + ">", {"200 characters"}}},
      "a.xml", &ParseXml);
}

}  // namespace
}  // namespace soslam
