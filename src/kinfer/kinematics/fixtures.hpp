// SPDX-License-Identifier: Apache-2.0
// Fixed objects that instruments and contacts refer to.
//
// A kind of fixture is a list in Fixtures and an entry of fixture_lists. The type of its elements (a point, a named
// point, a plane, a frame) says which numbers it has, and how files write it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "kinfer/kinematics/frame.hpp"

namespace kinfer {

/// A named point: a further target on the tool, in the tool frame, or a socket in the world.
struct Target {
  std::string name{};
  Vec3 xyz = Vec3::Zero();  ///< [m]
};

/// A plane in the world: the points x with normal · x = offset.
struct Plane {
  std::string name{};
  Mat3 rotation = Mat3::Identity();    ///< rotates z to the normal
  Vec3 small_rotation = Vec3::Zero();  ///< [rad] small rotations about x and y that an estimate may change
  double offset = 0.0;                 ///< [m]

  Vec3 normal() const;
};

/// A frame in the world: where an instrument stands.
struct NamedFrame {
  std::string name{};
  Frame frame{};
};

/// A known distance between two sockets.
struct SocketDistance {
  int a = 0, b = 0;       ///< indices into the sockets of the fixtures
  double distance = 0.0;  ///< [m]
  double sd = 0.0;        ///< [m]
};

struct Fixtures {
  std::vector<Vec3> anchors{};    ///< [m] of draw wires, in the base frame
  std::vector<Target> sockets{};  ///< in the world
  std::vector<Plane> planes{};
  std::vector<NamedFrame> stations{};  ///< of instruments that measure directions: world_T_station
  std::vector<SocketDistance> socket_distances{};
};

/// Whether the numbers of a fixture are known beforehand to some tolerance, or found from the data alone.
enum class FixturePrior { none, tolerance };

template <class T>
struct FixtureList {
  std::string_view kind;  ///< in parameter names and files
  std::vector<T> Fixtures::*list;
  FixturePrior prior;
};
template <class T>
FixtureList(std::string_view, std::vector<T> Fixtures::*, FixturePrior) -> FixtureList<T>;
inline constexpr std::tuple fixture_lists{FixtureList{"anchor", &Fixtures::anchors, FixturePrior::tolerance},
                                          FixtureList{"socket", &Fixtures::sockets, FixturePrior::none},
                                          FixtureList{"plane", &Fixtures::planes, FixturePrior::none},
                                          FixtureList{"station", &Fixtures::stations, FixturePrior::none}};
inline constexpr std::size_t fixture_kinds = std::tuple_size_v<decltype(fixture_lists)>;

/// Position of a kind in fixture_lists.
enum class FixtureKind : std::size_t {};
constexpr std::size_t index(FixtureKind kind) {
  return static_cast<std::size_t>(kind);
}

/// The kind of this name, which must be one.
constexpr FixtureKind fixture_kind(std::string_view name) {
  std::size_t next = 0, found = fixture_kinds;
  std::apply([&](const auto&... row) { ((found = row.kind == name ? next : found, ++next), ...); }, fixture_lists);
  return FixtureKind{found};
}

/// Multiplies the small rotation into the rotation matrix: the same fixture.
inline void fold(Vec3&) {}
inline void fold(Target&) {}
void fold(Plane& plane);
void fold(NamedFrame& fixture);

/// Calls visit(row of fixture_lists, list) for each kind.
template <class F, class Visit>
void for_each_fixture_list(F& fixtures, Visit visit) {
  std::apply([&](const auto&... row) { (visit(row, fixtures.*row.list), ...); }, fixture_lists);
}

}  // namespace kinfer
