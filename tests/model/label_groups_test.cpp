// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/label_groups.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

TEST(LabelGroupsTest, LabelsOfAGroupHaveOneRepresentative) {
  const LabelGroups groups("cup,bowl ; tv, laptop");
  EXPECT_EQ(groups.Group("bowl"), groups.Group("cup"));
  EXPECT_EQ(groups.Group("tv"), groups.Group("laptop"));
  EXPECT_NE(groups.Group("tv"), groups.Group("cup"));
  EXPECT_EQ(groups.Group("chair"), "chair");
  EXPECT_EQ(LabelGroups("").Group("cup"), "cup");
}

TEST(LabelGroupsTest, MalformedGroupsAreRefused) {
  for (const std::string groups : {"cup, ; tv", "cup,", ";", "cup,,tv", " "}) {
    ExpectError<SettingsError>([&] { LabelGroups{groups}; },
                               {"interchangeable_labels", groups, "'' as a label"});
  }
  ExpectError<SettingsError>([] { LabelGroups("cup, bowl; tv, cup"); },
                             {"interchangeable_labels", "'cup' twice"});
}

TEST(LabelInWordsTest, NamesAlternatives) {
  Object object;
  object.label = "chair";
  EXPECT_EQ(LabelInWords(object), "chair");
  object.labels = {{"chair", 1.0}};
  EXPECT_EQ(LabelInWords(object), "chair");
  object.labels = {{"armchair", 1.0}};
  EXPECT_EQ(LabelInWords(object), "chair (0 %; armchair 100 %)");
  object.labels = {{"armchair", 0.6}, {"chair", 0.4}};
  EXPECT_EQ(LabelInWords(object), "chair (40 %; armchair 60 %)");
}

}  // namespace
}  // namespace soslam
