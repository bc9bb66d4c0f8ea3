// SPDX-License-Identifier: BSD-3-Clause
// The usual mistakes in boxes, tracks, labels and true objects.
#include "support/dataset_checks_fixture.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::IsEmpty;

// Boxes.

TEST_F(DatasetChecksTest, BoxesThatCannotBe) {
  using Numbers = std::array<double, 4>;
  const std::vector<std::pair<Numbers (*)(const Box&), std::vector<std::string>>> cases = {
      {[](const Box& b) {
         return Numbers{b.x_min, b.y_min, b.Width(), b.Height()};
       },
       {"meant as upper left corner and size"}},
      {[](const Box& b) {
         return Numbers{b.x_min / 640, b.y_min / 480, b.x_max / 640, b.y_max / 480};
       },
       {"fractions of the image"}},
      {[](const Box& b) {
         return Numbers{3 * b.x_min, 3 * b.y_min, 3 * b.x_max, 3 * b.y_max};
       },
       {"images of another size"}},
      {[](const Box& b) {
         return Numbers{639 - b.x_max, b.y_min, 639 - b.x_min, b.y_max};
       },
       {"boxes are mirrored left to right", "as selfie cameras do"}},
      {[](const Box& b) {
         return Numbers{b.x_min, 479 - b.y_max, b.x_max, 479 - b.y_min};
       },
       {"boxes with y up"}}};
  for (const auto& [numbers, words] : cases) {
    dataset.box = numbers;
    ExpectRefused(words);
  }
}

TEST_F(DatasetChecksTest, CornersWhereSizesBelong) {
  WriteCoco([](const Box& b) { return std::array{b.x_min, b.y_min, b.x_max, b.y_max}; });
  ExpectRefused({"meant as two corners"});
}

// Boxes on the right of the image reach out of it.
TEST_F(DatasetChecksTest, CentresWhereCornersBelong) {
  WriteCoco([](const Box&) { return std::array{500.0, 300.0, 200.0, 150.0}; });
  ExpectRefused({"meant as centre and size"});
}

TEST_F(DatasetChecksTest, AFewBoxesOutOfTheImage) {
  dataset.box = [count = 0](const Box& b) mutable {
    const double shift = ++count % 8 == 0 ? 600.0 : 0.0;
    return std::array{b.x_min + shift, b.y_min, b.x_max + shift, b.y_max};
  };
  ExpectAmongWarnings({"box_convention: 14 of 115 boxes"});
}

// A box of the whole thing, also where the image cuts it.
TEST_F(DatasetChecksTest, BoxesOfWholeThingsAreNoOtherConvention) {
  dataset.box = [](const Box& b) {
    const auto wide = [](double x, double size) { return 0.5 * size + 4.0 * (x - 0.5 * size); };
    return std::array{wide(b.x_min, 640), wide(b.y_min, 480), wide(b.x_max, 640),
                      wide(b.y_max, 480)};
  };
  ExpectAmongWarnings({"whole objects that the image cuts"});
}

TEST_F(DatasetChecksTest, AnOrbitAroundThingsInTheMiddleIsNoSmallerImage) {
  dataset.camera.fx = dataset.camera.fy = dataset.written_camera.fx = dataset.written_camera.fy =
      200;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, ScoresInPerCent) {
  dataset.score = "87";
  ExpectWarning({"115 of 115 scores", "per cent"});
}

TEST_F(DatasetChecksTest, BoxesThatTheBorderGateDrops) {
  options_.border_px = 200;
  options_.min_observations = 1;
  ExpectWarning({"rejected_near_border", "border_px"});
}

// Objects that boxes are of.

TEST_F(DatasetChecksTest, HalfOfTheBoxesOfNoTrack) {
  dataset.first_object_id = -2;
  dataset.label = [](size_t) { return "ball"; };
  ExpectWarning({"rejected_without_object_id: 46 of 115", "a tracker that finds few tracks"});
}

// Labels.

TEST_F(DatasetChecksTest, LabelsThatFlicker) {
  const auto flicker = [](int of_seven) {
    return [of_seven, count = 0](size_t ball) mutable {
      return count++ % 7 < of_seven ? "thing" : PlausibleDataset::Labels()[ball];
    };
  };
  dataset.label = flicker(1);
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.label = flicker(3);
  ExpectWarning(
      {"labels_of_objects: detections.csv: 51 of 115 boxes", "ids that are of several things"});
}

TEST_F(DatasetChecksTest, LabelsThatNoBoxHasAreNamed) {
  options_.labels = "ball, cup";
  EXPECT_THAT(Warnings(), IsEmpty());
  options_.labels = "ball, Botle, sofa";
  ExpectWarning({"no box has the label Botle (bottle?), sofa of `labels`",
                 "expected labels of boxes: ball, bottle, bowl"});
  options_.labels = "Botle";
  ExpectError<NothingUsableError>([&] { Import(); }, {"115 other label", "Botle", "bottle"});
}

class ClassNamesTest : public DatasetChecksTest {
 protected:
  // YOLO's labels with these classes for the five balls, and these lines of names.
  void WriteYolo(const std::array<int, 5>& classes, const std::string& names) {
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      std::string lines;
      for (size_t ball = 0; ball < classes.size(); ++ball) {
        const Box box = dataset.BoxOf(ball, frame);
        lines += fmt::format("{} {} {} {} {}\n", classes[ball], (box.Centre().x() + 0.5) / 640,
                             (box.Centre().y() + 0.5) / 480, box.Width() / 640, box.Height() / 480);
      }
      Write(fmt::format("labels/{:06}.txt", frame), lines);
    }
    Write("names.txt", names);
    options_.detections = "labels";
    options_.folder.detections_format = DetectionsFormat::kYolo;
    options_.folder.class_names = "names.txt";
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  }
};

TEST_F(ClassNamesTest, AreRight) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\ntable\n\n");
  EXPECT_THAT(Warnings(), IsEmpty());
}

// The left edge is by 2 % of the width out of the image. The boxes of no track count, too.
TEST_F(ClassNamesTest, BoxesThatReachBeyondTheImage) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\n");
  dataset.objects = "";
  for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
    Write(fmt::format("labels/{:06}.txt", frame),
          "0 0.03 0.5 0.1 0.2 0.9 -1\n1 0.5 0.5 0.1 0.2 0.9 1\n");
  }
  ExpectAmongWarnings({"boxes_cut: labels: 24 of 48 boxes"});
}

TEST_F(ClassNamesTest, AreCountedFromOne) {
  WriteYolo({1, 3, 5, 7, 9}, "ball\na\ncup\nb\nvase\nc\nbowl\nd\nbottle\ne\n");
  ExpectWarning({"class_numbers: 0 of 120", "but 120 if", "one lower"});
}

TEST_F(ClassNamesTest, HaveABlankLineBetween) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\n\nvase\nbowl\nbottle\n");
  ExpectWarning({"names.txt has 1 blank lines"});
}

// Objects.

TEST_F(DatasetChecksTest, TrueObjectsWhereTheyAreSeen) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, IdsFromZeroInOneFile) {
  dataset.label = [](size_t) { return "ball"; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/0, /*unit_m=*/1.0);
  ExpectWarning({"objects_against_boxes", "subtract 1 from the object_id"});
}

// Full sizes; centimetres, where cameras are within objects, which have no outline then;
// kilometres.
TEST_F(DatasetChecksTest, HalfAxesOfAnotherUnit) {
  for (const auto& [factor, words] :
       {std::pair(2.0, "full sizes"), {100.0, "centimetres"}, {1e-3, "another unit"}}) {
    dataset.true_radius = factor * PlausibleDataset::kRadius;
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
    ExpectWarning({"object_half_axes", words});
  }
}

// Boxes of COCO, each turned by the angle that `angle_deg` gives to its ball.
class TurnedBoxesTest : public DatasetChecksTest {
 protected:
  using Numbers = std::array<double, 4>;

  TurnedBoxesTest() {
    dataset.label = [](size_t) { return "chair"; };
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  }

  void Write(const std::function<Numbers(const Box&)>& numbers) {
    WriteCoco(numbers, [&](size_t ball) {
      return nlohmann::json{{"track_id", ball + 1},
                            {"attributes", {{"rotation", angle_deg(ball)}}}};
    });
  }

  static Numbers CornerAndSize(const Box& b) {
    return {b.x_min + 0.5, b.y_min + 0.5, b.Width(), b.Height()};
  }

  std::function<double(size_t)> angle_deg = [](size_t ball) {
    return 20.0 + 30.0 * static_cast<double>(ball);
  };
};

TEST_F(TurnedBoxesTest, ThatAreRightAreNoOtherMistake) {
  Write(&CornerAndSize);
  ExpectWarning({"oblique_boxes", "120 of 120"});
  // Those of objects that the image cuts extend beyond it.
  Write([](const Box& b) {
    return b.Centre().x() < 320.0 ? Numbers{-20.0, 200.0, 80.0, 80.0} : CornerAndSize(b);
  });
  angle_deg = [](size_t) { return 45.0; };
  EXPECT_THAT(Warnings(), testing::Not(testing::Contains(testing::HasSubstr("box_convention"))));
}

TEST_F(TurnedBoxesTest, CornersWhereSizesBelong) {
  for (const double turn_deg : {30.0, 90.0, 200.0}) {
    angle_deg = [=](size_t) { return turn_deg; };
    Write([](const Box& b) { return Numbers{b.x_min, b.y_min, b.x_max, b.y_max}; });
    ExpectRefused({"meant as two corners"});
  }
}

TEST_F(TurnedBoxesTest, OfImagesOfAnotherSize) {
  Write([](const Box& b) {
    return Numbers{3 * b.x_min, 3 * b.y_min, 3 * b.Width(), 3 * b.Height()};
  });
  ExpectRefused({"images of another size"});
  Write([](const Box& b) {
    return Numbers{b.x_min / 640, b.y_min / 480, b.Width() / 640, b.Height() / 480};
  });
  ExpectRefused({"fractions of the image"});
}

// Upright boxes end at the border of the smaller image, oblique ones among them beyond it.
TEST_F(TurnedBoxesTest, AmongBoxesOfSmallerImages) {
  dataset.written_camera = {1280, 960, 1000.0, 1000.0, 639.5, 479.5};
  angle_deg = [](size_t ball) { return ball == 0 ? 45.0 : 0.0; };
  Write([](const Box& b) {
    const auto cut = [](double x, double size) {
      return std::clamp(0.5 * size + 3.0 * (x - 0.5 * size), 0.0, size);
    };
    const Eigen::Vector2d low(cut(b.x_min, 640), cut(b.y_min, 480));
    return Numbers{low.x(), low.y(), cut(b.x_max, 640) - low.x(), cut(b.y_max, 480) - low.y()};
  });
  ExpectAmongWarnings({"box_extent", "made smaller"});
}

// Turned boxes about balls have the balls' size.
TEST_F(TurnedBoxesTest, OfObjectsOfAnotherSize) {
  Write([](const Box& b) {
    return Numbers{b.x_min + 0.25 * b.Width(), b.y_min + 0.25 * b.Height(), 0.5 * b.Width(),
                   0.5 * b.Height()};
  });
  ExpectAmongWarnings({"object_half_axes: true objects look 2 times"});
}

// Sticks of 0.1 x 0.8 m that stand, in images of a rolled camera.
TEST_F(TurnedBoxesTest, OfStandingSticks) {
  dataset.roll_rad = 0.7;
  auto objects = nlohmann::json::parse(dataset.objects);
  for (nlohmann::json& object : objects) object["half_axes"] = {0.05, 0.05, 0.4};
  dataset.objects = objects.dump();
  const auto stick = [](const Box& b) {
    const Eigen::Vector2d size(0.25 * b.Width(), 2.0 * b.Height());
    return Numbers{b.Centre().x() - 0.5 * size.x(), b.Centre().y() - 0.5 * size.y(), size.x(),
                   size.y()};
  };
  for (const double turn : {-1.0, 1.0}) {
    angle_deg = [&](size_t) { return kDegPerRad * turn * dataset.roll_rad; };
    Write(stick);
    if (turn < 0.0) {
      ExpectWarning({"oblique_boxes"});
    } else {
      ExpectAmongWarnings({"object_half_axes"});
    }
  }
}

// The rotation by 40 degrees about z with qw first.
TEST_F(DatasetChecksTest, TrueQuaternionsWithScalarFirst) {
  dataset.true_quaternion = "0.94, 0, 0, 0.342";
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  ExpectWarning({"object_axes", "qw first"});
}

TEST_F(DatasetChecksTest, TrueObjectsInMillimetres) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1e-3);
  ExpectWarning({"another world, unit or order of axes"});
}

}  // namespace
}  // namespace soslam
