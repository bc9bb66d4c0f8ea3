// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "soslam/training/furniture_model.h"

namespace soslam {
namespace {

constexpr float kPiF = std::numbers::pi_v<float>;

// A model under construction: x front, y left, z up, the floor at z = 0.
class Assembly {
 public:
  explicit Assembly(Random* random) : random_(*random) {}

  float Uniform(double from, double to) { return static_cast<float>(random_.Uniform(from, to)); }
  bool Chance(double probability) { return random_.Chance(probability); }

  int AddMaterial(double darkest, double brightest) {
    const float grey = Uniform(darkest, brightest);
    const Eigen::Vector3f tint = random_.Normals(0.15);
    model_.materials.push_back(
        {grey * (Eigen::Vector3f::Ones() + tint).cwiseMax(0.2f), Uniform(0.0, 0.2), {}});
    return static_cast<int>(model_.materials.size()) - 1;
  }

  // A box with this centre and size, turned about its centre.
  void AddBox(int material, const Eigen::Vector3f& centre, const Eigen::Vector3f& size,
              const Eigen::Quaternionf& turn = Eigen::Quaternionf::Identity()) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0f, 1.0f}) {
        const Eigen::Vector3f normal = side * Eigen::Vector3f::Unit(axis);
        const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3);
        const Eigen::Vector3f v = Eigen::Vector3f::Unit((axis + 2) % 3);
        Eigen::Vector3f corners[4];
        int i = 0;
        for (const auto& [a, b] :
             {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
          corners[i++] =
              centre + turn * (0.5f * size.cwiseProduct(normal + static_cast<float>(a) * u +
                                                        static_cast<float>(b) * v));
        }
        AddTriangle(material, {corners[0], corners[1], corners[2]}, turn * normal);
        AddTriangle(material, {corners[0], corners[2], corners[3]}, turn * normal);
      }
    }
  }

  void AddTube(int material, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius) {
    constexpr int kSides = 8;
    const Eigen::Vector3f along = (to - from).normalized();
    const Eigen::Vector3f across = along.unitOrthogonal();
    const auto around = [&](int i) -> Eigen::Vector3f {
      return Eigen::AngleAxisf(2.0f * kPiF * static_cast<float>(i) / kSides, along) * across;
    };
    for (int i = 0; i < kSides; ++i) {
      const Eigen::Vector3f a = radius * around(i), b = radius * around(i + 1);
      const Eigen::Vector3f normal = (a + b).normalized();
      AddTriangle(material, {from + a, from + b, to + b}, normal);
      AddTriangle(material, {from + a, to + b, to + a}, normal);
      AddTriangle(material, {to, to + a, to + b}, along);
      AddTriangle(material, {from, from + a, from + b}, -along);
    }
  }

  // Four legs under a rectangle about the z axis, splayed outwards.
  void AddLegs(int material, const Eigen::Vector2f& half, float top, float radius, float splay) {
    for (const float x : {-1.0f, 1.0f}) {
      for (const float y : {-1.0f, 1.0f}) {
        const Eigen::Vector3f at(x * half.x(), y * half.y(), top);
        AddTube(material, at, {at.x() + x * splay, at.y() + y * splay, 0.0f}, radius);
      }
    }
  }

  // With the origin in the middle of the base.
  FurnitureModel Finished(const std::string& name) {
    Eigen::AlignedBox3f extent;
    for (const auto& corner : model_.corners) extent.extend(corner.position);
    const Eigen::Vector3f origin(extent.center().x(), extent.center().y(), extent.min().z());
    for (auto& corner : model_.corners) corner.position -= origin;
    model_.name = name;
    model_.size = extent.sizes();
    return model_;
  }

 private:
  void AddTriangle(int material, const std::array<Eigen::Vector3f, 3>& corners,
                   const Eigen::Vector3f& normal) {
    for (const Eigen::Vector3f& corner : corners) {
      model_.corners.push_back({corner, normal, Eigen::Vector2f::Zero()});
    }
    model_.materials_of_triangles.push_back(material);
  }

  Random& random_;
  FurnitureModel model_;
};

// Rotation that leans a thing whose front is x backwards by an angle (rad).
Eigen::Quaternionf Leaning(float angle) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(-angle, Eigen::Vector3f::UnitY()));
}

// Seat and back of a chair; returns the height of the seat's lower side.
float AddSeat(Assembly* a, float seat_z, float depth, float width) {
  const int seat = a->AddMaterial(0.03, 0.8);
  const int back = a->Chance(0.6) ? seat : a->AddMaterial(0.03, 0.8);
  const float thickness = a->Uniform(0.02, 0.1);
  a->AddBox(seat, {0, 0, seat_z}, {depth, width, thickness});
  const float height = a->Uniform(0.3, 0.65), gap = a->Uniform(0.0, 0.2);
  const float lean = a->Uniform(0.05, 0.35), back_width = width * a->Uniform(0.75, 1.02);
  const Eigen::Vector3f foot(-0.5f * depth, 0, seat_z + 0.5f * thickness);
  const Eigen::Vector3f up = Leaning(lean) * Eigen::Vector3f::UnitZ();
  const float part = height - gap;
  if (a->Chance(0.25)) {  // slats
    const int slats = 3 + static_cast<int>(a->Uniform(0, 4));
    for (int i = 0; i < slats; ++i) {
      const float y =
          back_width * ((static_cast<float>(i) + 0.5f) / static_cast<float>(slats) - 0.5f);
      a->AddBox(back, foot + 0.5f * height * up + Eigen::Vector3f(0, y, 0),
                {0.02f, 0.6f * back_width / static_cast<float>(slats), height}, Leaning(lean));
    }
    a->AddBox(back, foot + height * up, {0.03f, back_width, 0.06f}, Leaning(lean));
  } else {
    a->AddBox(back, foot + (gap + 0.5f * part) * up, {a->Uniform(0.02, 0.1), back_width, part},
              Leaning(lean));
    for (const float y : {-0.3f, 0.3f}) {
      a->AddTube(back, foot + Eigen::Vector3f(0, y * width, 0),
                 foot + height * up + Eigen::Vector3f(0, y * width, 0), 0.012f);
    }
  }
  return seat_z - 0.5f * thickness;
}

void AddArms(Assembly* a, float seat_z, float depth, float width) {
  const int material = a->AddMaterial(0.03, 0.6);
  const float height = seat_z + a->Uniform(0.15, 0.25);
  for (const float side : {-1.0f, 1.0f}) {
    const float y = 0.5f * side * width;
    a->AddBox(material, {0.05f * depth, y, height}, {0.6f * depth, 0.05f, 0.03f});
    a->AddTube(material, {0.1f * depth, y, seat_z}, {0.1f * depth, y, height}, 0.015f);
  }
}

void OfficeChair(Assembly* a) {
  const float seat_z = a->Uniform(0.42, 0.55), depth = a->Uniform(0.4, 0.5);
  const float width = a->Uniform(0.42, 0.52);
  const float under = AddSeat(a, seat_z, depth, width);
  if (a->Chance(0.6)) AddArms(a, seat_z, depth, width);
  const int metal = a->AddMaterial(0.02, 0.6);
  a->AddTube(metal, {0, 0, 0.08f}, {0, 0, under}, 0.03f);
  const float turn = a->Uniform(0, 2.0 * kPiF), reach = a->Uniform(0.26, 0.34);
  for (int i = 0; i < 5; ++i) {
    const float angle = turn + 2.0f * kPiF * static_cast<float>(i) / 5.0f;
    const Eigen::Vector3f tip(reach * std::cos(angle), reach * std::sin(angle), 0.06f);
    a->AddTube(metal, {0, 0, 0.12f}, tip, 0.02f);
    a->AddTube(metal, tip, tip - Eigen::Vector3f(0, 0, 0.06f), 0.025f);
  }
}

void CantileverChair(Assembly* a) {
  const float seat_z = a->Uniform(0.42, 0.48), depth = a->Uniform(0.4, 0.5);
  const float width = a->Uniform(0.42, 0.5);
  const float under = AddSeat(a, seat_z, depth, width);
  if (a->Chance(0.4)) AddArms(a, seat_z, depth, width);
  const int metal = a->AddMaterial(0.1, 0.8);
  for (const float side : {-0.5f, 0.5f}) {
    const float y = side * width, front = 0.5f * depth;
    a->AddTube(metal, {front, y, under}, {front, y, 0.02f}, 0.013f);
    a->AddTube(metal, {front, y, 0.02f}, {-front, y, 0.02f}, 0.013f);
    a->AddTube(metal, {front, y, under}, {-front, y, under}, 0.013f);
  }
  a->AddTube(metal, {-0.5f * depth, -0.5f * width, 0.02f}, {-0.5f * depth, 0.5f * width, 0.02f},
             0.013f);
}

void ShellChair(Assembly* a) {
  const int shell = a->AddMaterial(0.05, 0.9);
  const float width = a->Uniform(0.42, 0.55), seat_z = a->Uniform(0.4, 0.48);
  const float depth = a->Uniform(0.38, 0.48), height = a->Uniform(0.3, 0.45);
  constexpr int kParts = 7;  // of a bow from the seat's front over its rear to the back's top
  Eigen::Vector3f before(0.5f * depth, 0, seat_z);
  for (int i = 1; i <= kParts; ++i) {
    const float t = static_cast<float>(i) / kParts;
    const float x = 0.5f * depth * std::cos(kPiF * std::min(1.0f, 1.3f * t)) - 0.05f * t;
    const float z = seat_z + height * std::pow(std::max(0.0f, (t - 0.45f) / 0.55f), 1.2f);
    const Eigen::Vector3f at(x, 0, z);
    const Eigen::Vector3f along = at - before;
    const float angle = std::atan2(along.z(), -along.x());
    a->AddBox(shell, 0.5f * (at + before),
              {along.norm() + 0.01f, width * (1.0f - 0.15f * t), 0.02f},
              Eigen::Quaternionf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY())));
    before = at;
  }
  if (a->Chance(0.5)) AddArms(a, seat_z, depth, width);
  const int legs = a->AddMaterial(0.05, 0.8);
  a->AddLegs(legs, {0.3f * depth, 0.3f * width}, seat_z, a->Uniform(0.008, 0.02),
             a->Uniform(0.0, 0.08));
}

void Sofa(Assembly* a) {
  const int cloth = a->AddMaterial(0.05, 0.8);
  const int cushion = a->Chance(0.7) ? cloth : a->AddMaterial(0.05, 0.8);
  const float depth = a->Uniform(0.75, 1.0), width = a->Uniform(1.2, 2.4);
  const float seat = a->Uniform(0.38, 0.45), back = a->Uniform(0.65, 0.9);
  const float arm = a->Chance(0.85) ? a->Uniform(0.08, 0.25) : 0.0f;
  const float lift = a->Chance(0.5) ? a->Uniform(0.08, 0.18) : 0.0f;
  const float thickness = a->Uniform(0.15, 0.3), inner = width - 2.0f * arm;
  a->AddBox(cloth, {0, 0, 0.5f * (lift + seat - 0.12f)}, {depth, width, seat - 0.12f - lift});
  a->AddBox(cloth, {-0.5f * (depth - thickness), 0, 0.5f * (lift + back)},
            {thickness, width, back - lift}, Leaning(a->Uniform(0.0, 0.12)));
  if (arm > 0.0f) {
    const float arm_z = seat + a->Uniform(0.05, 0.25);
    for (const float side : {-0.5f, 0.5f}) {
      a->AddBox(cloth, {0, side * (width - arm), 0.5f * (lift + arm_z)},
                {depth, arm, arm_z - lift});
    }
  }
  const int seats = std::max(1, static_cast<int>(inner / a->Uniform(0.55, 0.9)));
  for (int i = 0; i < seats; ++i) {
    const float each = inner / static_cast<float>(seats);
    const float y = -0.5f * inner + each * (static_cast<float>(i) + 0.5f);
    a->AddBox(cushion, {0.5f * thickness, y, seat - 0.06f},
              {depth - thickness, each - 0.015f, 0.12f});
    a->AddBox(cushion, {-0.5f * depth + thickness + 0.07f, y, seat + 0.2f},
              {0.13f, each - 0.02f, 0.38f}, Leaning(0.2f));
  }
  if (a->Chance(0.3)) {  // an L: one end reaches forward
    const float side = a->Chance(0.5) ? 1.0f : -1.0f, each = inner / static_cast<float>(seats + 1);
    const float reach = a->Uniform(0.5, 0.9);
    a->AddBox(cloth,
              {0.5f * (depth + reach), side * 0.5f * (width - each - 0.1f), 0.5f * (lift + seat)},
              {reach, each + 0.1f, seat - lift});
  }
  if (lift > 0.0f) {
    a->AddLegs(a->AddMaterial(0.03, 0.5), {0.45f * depth, 0.47f * width}, lift + 0.02f, 0.025f, 0);
  }
}

void Monitor(Assembly* a) {
  const float width = a->Chance(0.5) ? a->Uniform(0.4, 0.65) : a->Uniform(0.7, 1.3);
  const float height = width * a->Uniform(0.54, 0.7), lift = a->Uniform(0.06, 0.16);
  const float thickness = a->Uniform(0.015, 0.06), lean = a->Uniform(0.0, 0.12);
  const int frame = a->AddMaterial(0.02, 0.5);
  const int screen = a->Chance(0.7) ? a->AddMaterial(0.01, 0.08) : a->AddMaterial(0.2, 0.9);
  const Eigen::Vector3f middle(0, 0, lift + 0.5f * height);
  const float border = a->Uniform(0.01, 0.03);
  a->AddBox(frame, middle, {thickness, width, height}, Leaning(lean));
  a->AddBox(screen, middle + Leaning(lean) * Eigen::Vector3f(0.5f * thickness, 0, 0),
            {0.004f, width - 2 * border, height - 2 * border}, Leaning(lean));
  if (a->Chance(0.5)) {  // electronics at the back
    a->AddBox(frame, middle - Eigen::Vector3f(0.5f * thickness + 0.015f, 0, 0.1f * height),
              {0.04f, 0.6f * width, 0.5f * height}, Leaning(lean));
  }
  const int stand = a->AddMaterial(0.02, 0.6);
  a->AddBox(stand, {-thickness, 0, 0.5f * (lift + 0.1f)},
            {0.03f, 0.08f * width + 0.03f, lift + 0.1f});
  a->AddBox(stand, {0.02f, 0, 0.01f},
            {a->Uniform(0.15, 0.26), a->Uniform(0.25, 0.5) * width, 0.015f});
}

void AddKeys(Assembly* a, float middle_x, float depth, float width, float z) {
  const int keys = a->AddMaterial(0.02, 0.9);
  constexpr int kRows = 5;
  const int columns = width > 0.38f ? 18 : 13;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool is_bar = row == 0 && column > 3 && column < 9;  // space, at the user's side
      if (is_bar && column != 6) continue;
      const float pitch_x = depth / kRows, pitch_y = width / static_cast<float>(columns);
      a->AddBox(keys,
                {middle_x + 0.5f * depth - pitch_x * (static_cast<float>(row) + 0.5f),
                 -0.5f * width + pitch_y * (static_cast<float>(column) + 0.5f), z},
                {0.8f * pitch_x, (is_bar ? 4.8f : 0.8f) * pitch_y, 0.008f});
    }
  }
}

void Laptop(Assembly* a) {
  const float width = a->Uniform(0.28, 0.4), depth = width * a->Uniform(0.62, 0.75);
  const int body = a->AddMaterial(0.02, 0.8);
  a->AddBox(body, {0, 0, 0.01f}, {depth, width, 0.02f});
  AddKeys(a, -0.15f * depth, 0.5f * depth, 0.9f * width, 0.022f);
  a->AddBox(a->AddMaterial(0.05, 0.5), {0.3f * depth, 0, 0.021f},
            {0.28f * depth, 0.3f * width, 0.002f});
  const float lean = a->Uniform(0.0, 0.5);
  const Eigen::Vector3f hinge(-0.5f * depth, 0, 0.02f);
  const Eigen::Vector3f middle = hinge + Leaning(lean) * Eigen::Vector3f(0, 0, 0.5f * depth);
  a->AddBox(body, middle, {0.01f, width, depth}, Leaning(lean));
  a->AddBox(a->Chance(0.6) ? a->AddMaterial(0.01, 0.08) : a->AddMaterial(0.2, 0.9),
            middle + Leaning(lean) * Eigen::Vector3f(0.006f, 0, 0),
            {0.002f, 0.94f * width, 0.9f * depth}, Leaning(lean));
}

void Keyboard(Assembly* a) {
  const float width = a->Chance(0.6) ? a->Uniform(0.42, 0.48) : a->Uniform(0.26, 0.34);
  const float depth = a->Uniform(0.12, 0.19);
  a->AddBox(a->AddMaterial(0.02, 0.9), {0, 0, 0.01f}, {depth, width, a->Uniform(0.01, 0.025)},
            Leaning(a->Uniform(-0.02, 0.12)));
  AddKeys(a, 0.0f, 0.82f * depth, 0.95f * width, 0.024f);
}

// Doors and drawers with handles on the front of a body.
void AddFronts(Assembly* a, float depth, float width, float bottom, float top, int columns,
               int rows) {
  const int front = a->Chance(0.5) ? 0 : a->AddMaterial(0.05, 0.9);
  const int handle = a->AddMaterial(0.02, 0.9);
  const int kind = static_cast<int>(a->Uniform(0, 3));  // knobs, bars across, bars upright
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const float w = width / static_cast<float>(columns),
                  h = (top - bottom) / static_cast<float>(rows);
      const float y = -0.5f * width + w * (static_cast<float>(i) + 0.5f);
      const float z = bottom + h * (static_cast<float>(j) + 0.5f);
      a->AddBox(front, {0.5f * depth + 0.008f, y, z}, {0.016f, w - 0.012f, h - 0.012f});
      const float inwards = columns > 1 && rows == 1 ? (i % 2 == 0 ? 0.4f : -0.4f) * w : 0.0f;
      const Eigen::Vector3f at(0.5f * depth + 0.03f, y + inwards, z);
      if (kind == 0) a->AddBox(handle, at, {0.03f, 0.03f, 0.03f});
      if (kind == 1) a->AddBox(handle, at, {0.02f, 0.3f * w, 0.015f});
      if (kind == 2) a->AddBox(handle, at, {0.02f, 0.015f, 0.3f * h});
    }
  }
}

void Cabinet(Assembly* a) {
  const float width = a->Uniform(0.4, 1.8), depth = a->Uniform(0.3, 0.65),
              height = a->Uniform(0.45, 2.1);
  const float lift = a->Chance(0.5) ? a->Uniform(0.05, 0.2) : 0.0f;
  const int body = a->AddMaterial(0.05, 0.9);
  if (a->Chance(0.35)) {  // open shelves
    const int boards = 2 + static_cast<int>(height / a->Uniform(0.28, 0.45));
    for (int i = 0; i < boards; ++i) {
      const float z =
          lift + (height - lift) * static_cast<float>(i) / static_cast<float>(boards - 1);
      a->AddBox(body, {0, 0, z}, {depth, width, 0.022f});
      if (i + 1 == boards || a->Chance(0.3)) continue;
      const float gap = (height - lift) / static_cast<float>(boards - 1);
      for (float y = -0.45f * width; y < 0.4f * width;) {  // books
        const float w = a->Uniform(0.02, 0.06), h = gap * a->Uniform(0.5, 0.9);
        a->AddBox(a->AddMaterial(0.03, 0.9), {0.1f * depth, y + 0.5f * w, z + 0.5f * h + 0.011f},
                  {0.7f * depth, w, h});
        y += w + (a->Chance(0.1) ? 0.2f : 0.002f);
      }
    }
    for (const float side : {-0.5f, 0.5f}) {
      a->AddBox(body, {0, side * width, 0.5f * (lift + height)}, {depth, 0.022f, height - lift});
    }
    if (a->Chance(0.7)) {
      a->AddBox(body, {-0.5f * depth, 0, 0.5f * (lift + height)}, {0.01f, width, height - lift});
    }
    return;
  }
  a->AddBox(body, {0, 0, 0.5f * (lift + height)}, {depth, width, height - lift});
  if (lift > 0.0f) a->AddLegs(body, {0.45f * depth, 0.46f * width}, lift + 0.01f, 0.02f, 0.0f);
  const int columns = std::max(1, static_cast<int>(width / a->Uniform(0.35, 0.6)));
  const int rows =
      a->Chance(0.5) ? 1 : std::max(1, static_cast<int>(height / a->Uniform(0.18, 0.4)));
  AddFronts(a, depth, width, lift, height, columns, rows);
}

void Refrigerator(Assembly* a) {
  const float width = a->Uniform(0.5, 0.75), depth = a->Uniform(0.55, 0.72),
              height = a->Uniform(0.85, 2.0);
  a->AddBox(a->AddMaterial(0.3, 0.95), {0, 0, 0.5f * height}, {depth, width, height});
  const float split = height * (a->Chance(0.7) ? a->Uniform(0.3, 0.7) : 1.0f);
  AddFronts(a, depth, width, 0.04f, split, 1, 1);
  if (split < height) AddFronts(a, depth, width, split, height, 1, 1);
}

void Desk(Assembly* a) {
  const float width = a->Uniform(0.9, 1.8), depth = a->Uniform(0.5, 0.8),
              height = a->Uniform(0.7, 0.77);
  const int body = a->AddMaterial(0.05, 0.9);
  a->AddBox(body, {0, 0, height}, {depth, width, a->Uniform(0.02, 0.05)});
  a->AddLegs(body, {0.45f * depth, 0.47f * width}, height, a->Uniform(0.015, 0.035), 0.0f);
  const float side = a->Chance(0.5) ? 0.32f : -0.32f;
  if (a->Chance(0.8)) {  // drawers at one side
    const float w = 0.28f * width, bottom = a->Uniform(0.05, 0.4);
    a->AddBox(body, {0, side * width, 0.5f * (bottom + height)},
              {0.9f * depth, w, height - bottom});
    for (int i = 0; i < 3; ++i) {
      const float h = (height - bottom) / 3.0f;
      const float z = bottom + h * (static_cast<float>(i) + 0.5f);
      a->AddBox(body, {0.46f * depth, side * width, z}, {0.02f, w - 0.02f, h - 0.015f});
      a->AddBox(a->AddMaterial(0.02, 0.9), {0.48f * depth, side * width, z},
                {0.02f, 0.3f * w, 0.015f});
    }
  }
  if (a->Chance(0.7)) {  // a board at the rear
    a->AddBox(body, {-0.42f * depth, 0, 0.72f * height}, {0.02f, 0.9f * width, 0.45f * height});
  }
}

void Bed(Assembly* a) {
  const float width = a->Uniform(0.8, 1.9), length = a->Uniform(1.9, 2.15),
              seat = a->Uniform(0.3, 0.5);
  const int frame = a->AddMaterial(0.05, 0.8), linen = a->AddMaterial(0.2, 0.95);
  const float board = a->Uniform(0.03, 0.1);
  a->AddBox(frame, {0, 0, 0.6f * seat}, {length, width, 0.4f * seat});
  a->AddBox(linen, {0, 0, seat}, {0.98f * length, 0.97f * width, 0.18f});
  if (a->Chance(0.7)) {  // a cover of the lower part
    a->AddBox(a->AddMaterial(0.05, 0.9), {0.15f * length, 0, seat + 0.02f},
              {0.7f * length, width, 0.18f});
  }
  const float head = a->Uniform(0.65, 1.2);
  if (a->Chance(0.85)) {
    a->AddBox(frame, {-0.5f * (length + board), 0, 0.5f * head}, {board, width, head});
  }
  if (a->Chance(0.3)) {
    const float foot = seat + a->Uniform(0.05, 0.3);
    a->AddBox(frame, {0.5f * (length + board), 0, 0.5f * foot}, {board, width, foot});
  }
  const int pillow = a->AddMaterial(0.3, 0.95), pillows = width > 1.2f ? 2 : 1;
  for (int i = 0; i < pillows; ++i) {
    const float y = pillows == 1 ? 0.0f : (i == 0 ? -0.25f : 0.25f) * width;
    a->AddBox(pillow, {-0.4f * length, y, seat + 0.14f}, {0.35f, 0.6f, 0.13f},
              Leaning(a->Uniform(0.0, 0.5)));
  }
  a->AddLegs(frame, {0.47f * length, 0.45f * width}, 0.5f * seat, 0.03f, 0.0f);
}

const std::map<std::string, void (*)(Assembly*)> kKinds = {{"office chair", &OfficeChair},
                                                           {"cantilever chair", &CantileverChair},
                                                           {"shell chair", &ShellChair},
                                                           {"sofa", &Sofa},
                                                           {"monitor", &Monitor},
                                                           {"laptop", &Laptop},
                                                           {"keyboard", &Keyboard},
                                                           {"cabinet", &Cabinet},
                                                           {"refrigerator", &Refrigerator},
                                                           {"desk", &Desk},
                                                           {"bed", &Bed}};

}  // namespace

std::optional<FurnitureModel> ParametricModel(const std::string& kind, Random* random) {
  const auto make = kKinds.find(kind);
  if (make == kKinds.end()) return std::nullopt;
  Assembly assembly(random);
  make->second(&assembly);
  return assembly.Finished(kind);
}

}  // namespace soslam
