// SPDX-License-Identifier: Apache-2.0
// Kinds of external measurements of a pose, and the accuracy of the instruments that make them.
//
// A kind is a struct with its traits, a list in PoseMeasurements and an entry of measurement_lists; all else that the
// program does with every kind loops over that list. Further parts of a kind: its residual
// (estimate/poses/instruments), its columns (io/pose_set/instruments) and its fixture, if any (kinematics/fixtures).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Accuracy of one measurement, one sigma.
struct Instrument {
  double sigma = 0.0;                          ///< [m] per axis; 0: not stated
  double sigma_angle = 0.0;                    ///< [rad] per axis; 0: not stated
  double ppm = 0.0;                            ///< [1e-6] plus this fraction of the distance from the world origin
  std::optional<double> sigma_distance = {};   ///< [m] of draw wires and ball-bars; none: sigma
  std::optional<double> sigma_contact = {};    ///< [m] of sockets and planes, per axis; none: sigma
  std::optional<double> sigma_tilt = {};       ///< [m/s²] per axis; none: estimated from the residuals
  std::optional<double> sigma_direction = {};  ///< [rad] across the line of sight, per axis; none: from the residuals

  bool states_lengths() const { return sigma > 0.0; }
};

/// The instrument with this accuracy of lengths [m] where it states none.
inline Instrument with_lengths(Instrument instrument, double sigma) {
  if (!instrument.states_lengths()) instrument.sigma = sigma;
  return instrument;
}

/// Standard deviation per axis of a position measured at `position` [m]: sigma + ppm · distance from the world origin.
double position_sd(const Instrument& instrument, const Vec3& position);

enum class ResidualUnit { length, angle, acceleration };  ///< [m], [rad], [m/s²]

/// Optional standard deviations of an instrument, by their keys in files.
struct InstrumentSigma {
  std::string_view key;
  ResidualUnit unit;
  std::optional<double> Instrument::*value;
};
inline constexpr InstrumentSigma instrument_sigmas[] = {
    {"sigma_distance", ResidualUnit::length, &Instrument::sigma_distance},
    {"sigma_contact", ResidualUnit::length, &Instrument::sigma_contact},
    {"sigma_tilt", ResidualUnit::acceleration, &Instrument::sigma_tilt},
    {"sigma_direction", ResidualUnit::angle, &Instrument::sigma_direction},
};

/// What a kind of measurement determines, besides its own fixture.
struct Observes {
  bool base_position = false, base_rotation = false, tool_position = false, tool_rotation = false;
  bool scale = false;  ///< it measures a length
};

struct MeasurementTraits {
  std::string_view name;      ///< stable identifier for programs
  std::string_view plural;    ///< as inspect counts them
  std::string_view quantity;  ///< whose errors are reported
  int rows;                   ///< of one residual, 1 to 3
  ResidualUnit unit;
  Observes observes;
  std::string_view fixture{};                          ///< kind of fixture that it refers to; empty: none
  std::optional<double> Instrument::*sigma = nullptr;  ///< null: default_sigma
  double Instrument::*default_sigma = nullptr;         ///< where `sigma` is not given; null: unknown

  /// [m], [rad] or [m/s²]; 0 where it is unknown.
  double sigma_of(const Instrument& instrument) const {
    const double fallback = default_sigma ? instrument.*default_sigma : 0.0;
    return sigma ? (instrument.*sigma).value_or(fallback) : fallback;
  }
};

/// Position of the tool point (target −1) or of a further target on the tool, in the world frame.
struct PointMeasurement {
  int row = 0;
  int target = -1;               ///< index into FixtureNames::targets; −1: the tool point
  Vec3 position = Vec3::Zero();  ///< [m]
  std::optional<Vec3> sd;        ///< [m] along `axes`, where the file gives it
  std::optional<Mat3> axes{};    ///< columns: directions in the world, orthonormal; none: the world's axes

  static constexpr MeasurementTraits traits{
      .name = "point",
      .plural = "positions",
      .quantity = "position",
      .rows = 3,
      .unit = ResidualUnit::length,
      .observes = {.base_position = true, .base_rotation = true, .tool_position = true, .scale = true},
      .default_sigma = &Instrument::sigma};
};

/// Orientation of the tool in the world frame.
struct OrientationMeasurement {
  int row = 0;
  Quat orientation = Quat::Identity();
  std::optional<Vec3> sd{};    ///< [rad] about `axes`, where the file gives it
  std::optional<Mat3> axes{};  ///< as of a point
  /// [m rad] cross-covariance of the position error of the tool point measured in the same row (rows: world x y z) and
  /// this orientation error, a small rotation about the world axes (columns); none: independent.
  std::optional<Mat3> covariance_with_point{};

  static constexpr MeasurementTraits traits{.name = "orientation",
                                            .plural = "orientations",
                                            .quantity = "orientation",
                                            .rows = 3,
                                            .unit = ResidualUnit::angle,
                                            .observes = {.base_rotation = true, .tool_rotation = true},
                                            .default_sigma = &Instrument::sigma_angle};
};

/// The tool point touches a fixed point of unknown position (ball in socket).
struct SocketContact {
  int row = 0;
  int socket = 0;  ///< index into FixtureNames::sockets

  static constexpr int SocketContact::*fixture_index = &SocketContact::socket;
  static constexpr MeasurementTraits traits{.name = "contact",
                                            .plural = "socket contacts",
                                            .quantity = "ball in socket",
                                            .rows = 3,
                                            .unit = ResidualUnit::length,
                                            .observes = {.tool_position = true},
                                            .fixture = "socket",
                                            .sigma = &Instrument::sigma_contact,
                                            .default_sigma = &Instrument::sigma};
};

/// Distance of the tool point from a fixed anchor (draw wire).
struct DistanceMeasurement {
  int row = 0;
  int anchor = 0;         ///< from 0; files count from 1
  double distance = 0.0;  ///< [m]

  static constexpr int DistanceMeasurement::*fixture_index = &DistanceMeasurement::anchor;
  static constexpr MeasurementTraits traits{.name = "distance",
                                            .plural = "distances from anchors",
                                            .quantity = "distance",
                                            .rows = 1,
                                            .unit = ResidualUnit::length,
                                            .observes = {.tool_position = true, .scale = true},
                                            .fixture = "anchor",
                                            .sigma = &Instrument::sigma_distance,
                                            .default_sigma = &Instrument::sigma};
};

/// Distance between the tool points of two poses (ball-bar).
struct PairDistance {
  int row = 0;
  int other = 0;          ///< the other row, after `row`
  double distance = 0.0;  ///< [m]

  static constexpr MeasurementTraits traits{.name = "pair",
                                            .plural = "pairwise distances",
                                            .quantity = "ball-bar length",
                                            .rows = 1,
                                            .unit = ResidualUnit::length,
                                            .observes = {.tool_position = true, .scale = true},
                                            .sigma = &Instrument::sigma_distance,
                                            .default_sigma = &Instrument::sigma};
};

/// The tool point touches a fixed plane of unknown pose.
struct PlaneContact {
  int row = 0;
  int plane = 0;  ///< index into FixtureNames::planes

  static constexpr int PlaneContact::*fixture_index = &PlaneContact::plane;
  static constexpr MeasurementTraits traits{.name = "plane",
                                            .plural = "plane contacts",
                                            .quantity = "distance from the plane",
                                            .rows = 1,
                                            .unit = ResidualUnit::length,
                                            .observes = {.tool_position = true},
                                            .fixture = "plane",
                                            .sigma = &Instrument::sigma_contact,
                                            .default_sigma = &Instrument::sigma};
};

/// Specific force measured on the tool at rest: +g upward, in the tool frame.
struct TiltMeasurement {
  int row = 0;
  Vec3 specific_force = Vec3::Zero();  ///< [m/s²]

  static constexpr MeasurementTraits traits{.name = "tilt",
                                            .plural = "tilts",
                                            .quantity = "tilt",
                                            .rows = 2,
                                            .unit = ResidualUnit::acceleration,
                                            .observes = {.base_rotation = true, .tool_rotation = true},
                                            .sigma = &Instrument::sigma_tilt};
};

/// Direction in which a station of unknown position and orientation sees the tool point (theodolite, calibrated
/// camera).
struct DirectionMeasurement {
  int row = 0;
  int station = 0;                 ///< index into FixtureNames::stations
  Vec3 direction = Vec3::UnitX();  ///< unit, in the station's frame

  static constexpr int DirectionMeasurement::*fixture_index = &DirectionMeasurement::station;
  static constexpr MeasurementTraits traits{.name = "direction",
                                            .plural = "directions",
                                            .quantity = "line of sight",
                                            .rows = 2,
                                            .unit = ResidualUnit::angle,
                                            .observes = {.tool_position = true},
                                            .fixture = "station",
                                            .sigma = &Instrument::sigma_direction};
};

/// One list for each kind of measurement; each entry names its row.
struct PoseMeasurements {
  std::vector<PointMeasurement> points{};
  std::vector<OrientationMeasurement> orientations{};
  std::vector<SocketContact> contacts{};
  std::vector<DistanceMeasurement> distances{};
  std::vector<PairDistance> pairs{};
  std::vector<PlaneContact> plane_contacts{};
  std::vector<TiltMeasurement> tilts{};
  std::vector<DirectionMeasurement> directions{};
};

/// The kinds, in the order of the residual blocks.
inline constexpr std::tuple measurement_lists{&PoseMeasurements::points,   &PoseMeasurements::orientations,
                                              &PoseMeasurements::contacts, &PoseMeasurements::distances,
                                              &PoseMeasurements::pairs,    &PoseMeasurements::plane_contacts,
                                              &PoseMeasurements::tilts,    &PoseMeasurements::directions};
inline constexpr std::size_t measurement_kinds = std::tuple_size_v<decltype(measurement_lists)>;

/// Names of the objects that measurements index: targets on the tool, and fixtures.
struct FixtureNames {
  std::vector<std::string> targets{}, sockets{}, planes{}, stations{};
};

/// Names of the fixtures of one kind.
struct FixtureNameList {
  std::string_view kind;
  std::vector<std::string> FixtureNames::*names;
};
inline constexpr FixtureNameList fixture_name_lists[] = {
    {"socket", &FixtureNames::sockets}, {"plane", &FixtureNames::planes}, {"station", &FixtureNames::stations}};

/// Position of a kind in measurement_lists.
enum class MeasurementKind : std::size_t {};
constexpr std::size_t index(MeasurementKind kind) {
  return static_cast<std::size_t>(kind);
}
template <class M>
inline constexpr MeasurementKind kind_of = [] {
  std::size_t next = 0, found = measurement_kinds;
  std::apply(
      [&](auto... list) {
        ((found = std::is_same_v<decltype(list), std::vector<M> PoseMeasurements::*> ? next : found, ++next), ...);
      },
      measurement_lists);
  return MeasurementKind{found};
}();
const MeasurementTraits& traits_of(MeasurementKind kind);
/// The stable identifier for programs: "point", "orientation", "contact", …
std::string_view name(MeasurementKind kind);
std::optional<MeasurementKind> measurement_kind(std::string_view name);

/// The measurements of one kind in a pose set.
template <class M, class Set>
auto& list_of(Set& set) {
  return set.*std::get<std::vector<M> PoseMeasurements::*>(measurement_lists);
}

/// Calls visit(list) for the list of each kind in a pose set, in order.
template <class Set, class Visit>
void for_each_list(Set& set, Visit visit) {
  std::apply([&](auto... list) { (visit(set.*list), ...); }, measurement_lists);
}

/// Kinds whose entries refer to a fixture.
template <class M>
concept RefersToFixture = requires {
  M::fixture_index;
};

/// The names of the fixtures of a kind; null where they have numbers only.
std::vector<std::string>* find_fixture_names(FixtureNames& names, std::string_view kind);
const std::vector<std::string>* find_fixture_names(const FixtureNames& names, std::string_view kind);

}  // namespace kinfer
