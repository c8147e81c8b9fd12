// SPDX-License-Identifier: Apache-2.0
// Settings of the filter that no log determines, with the data that they were set on.
#pragma once

#include "kinfer/base/threshold.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/model/acceleration_process.hpp"

namespace kinfer::track {

/// Joint accelerations of machines; tenfold densities change rms errors of the simulated machines by less than 30 %.
inline constexpr AccelerationProcess machine_acceleration{.sd = 3.9, .time = 0.5};
/// [s] over which a joint's accelerations are averaged: a drive may be livelier than that of the identification.
inline constexpr double liveliness_time = 5.0;
inline constexpr AccelerationProcess prismatic_acceleration{.sd = 1.0, .time = 0.5, .is_measured = true};
inline constexpr double min_acceleration_time = 0.15;  ///< [s] of hands
inline constexpr double acceleration_room = 2.0;       ///< a drive may be so much livelier than that of the chain

/// A base that moves: a machine that rocks on its tracks. Simulated machines on a rocking and on a yawing base.
inline constexpr AccelerationProcess base_rotation{.sd = 0.6, .time = 0.3}, base_translation{.sd = 0.3, .time = 0.3};
inline constexpr double base_velocity_sd = 0.3;    ///< [m/s] of a base that begins to move
inline constexpr double base_velocity_time = 1.0;  ///< [s] its correlation time
/// Its level [m/s] is that of the last [s]; before any row it is this, and counts as much as [s] of motion; least.
/// Simulated excavators 51 to 53 on rocking bases, industrial.
inline constexpr double first_base_speed = 0.1, base_speed_memory = 10.0, base_speed_prior = 2.0,
                        least_base_speed = 0.02;

/// Of prismatic joints: least speed [m/s] and correlation times [s] of velocity and position about what was seen; room
/// beyond it, and half the range where nothing was seen [m].
inline constexpr double prismatic_speed = 0.2, prismatic_velocity_time = 1.0, prismatic_position_time = 10.0;
inline constexpr double prismatic_margin = 0.1, unseen_prismatic_half = 1.0;

/// A prismatic joint may rest where its velocity has varied by less than this [m/s] for so long [s]; it creeps by less
/// than this [m/s]. Simulated cranes.
inline constexpr double prismatic_steadiness = 1e-2, joint_rest = 1.0, prismatic_creep = 1e-3;

/// Likewise of a revolute joint beside a sensor that is lost [rad/s]; correlation time of its creep [s]. The variance
/// of its acceleration by one block alone, over that of its process, below which the others show it: (0.02 rad/s²
/// of 3.9)² where an accelerometer is 0.4 m away, 1 of the last joint without its own sensor. Six-axis arm 1,
/// industrial.
inline constexpr double revolute_steadiness = 1e-2, revolute_creep = 1e-3, revolute_rest_time = 1.0;
inline constexpr double shown_acceleration = 0.1;

/// A revolute joint that no sensor shows: least speed [rad/s], correlation time of its velocity [s]. With a velocity
/// that lasts, a joint whose sensor is lost in motion is extrapolated beyond all limits.
inline constexpr double least_revolute_speed = 0.1, unseen_velocity_time = 1.0;

inline constexpr double still_base_walk = 2e-5;  ///< [rad/√s] tilting of a base that stands still: soil, outriggers

inline constexpr double min_stray = 1e-3,
                        min_stray_time =
                            0.02;  ///< [rad], [s] looser than that a revolute joint is tracked as a spherical one

/// Share of the variance of gravity's component along an axis that is considered by which a bias changes in a turn of
/// 1 rad [1/rad]: less than all of it, since machines turn to and fro. Simulated cranes 1 to 4 (0.1 to 0.3 alike).
inline constexpr double posture_walk = 0.1;

/// A bias' change between logs, in standard deviations of its instability, and at least.
inline constexpr double bias_change = 3.0;
/// [1] of a bias that changes from one power-up to the next. With 1, DIODEM had a false alarm and iiwa 1.29 instead of
/// 1.22°; with 0.02 a sensor of UR5 was called moved.
inline constexpr double power_up_part = 0.5;
inline constexpr InsLevel min_bias_change{.rate = 2e-5, .force = 1e-4};
inline constexpr InsLevel min_bias_instability{.rate = 2e-6, .force = 2e-5};
inline constexpr InsLevel min_noise{.rate = 1e-5, .force = 1e-4};

/// An instrument whose innovation is further off (squared, in its covariance; three axes) is trusted less.
KINFER_THRESHOLD(track, outlier_limit, 30.0);
/// Relative change of an instrument's variance in an update, by its squared leave-one-out innovation over its
/// expectation: a second at 50 updates a second. DIODEM trial 1, first half.
KINFER_THRESHOLD(track, inflation_gain, 2e-2);
/// A sensor that stands alone is followed no faster than so many times the median of all sensors: it is a fault rather
/// than noise. DIODEM trial 1, first half.
inline constexpr double lone_inflation = 1.5;
inline constexpr double max_inflation = 1e4;
inline constexpr double joint_change_gain = 0.1;  ///< in an update, of how far a doubted joint's change is followed
inline constexpr int change_rows = 6;             ///< of a joint's change: angular velocity and specific force

/// [rad] A zero known no better than this, which is as much as the start asks of gravity, is no zero. Excavators and
/// arms identified on level ground have 2.7 and more, those identified on a slope of 3 degrees 0.02.
inline constexpr double unknown_zero_sd = 0.35;
/// Of the direction in the base of an axis that may be anywhere on a cone, in each direction: standard deviation over
/// the cone's angle where it is considered (the circle's second moment about one of its places) and where it is
/// estimated. The angle [rad] up to which it is considered, and up to which it is estimated. Excavators, arms, trees
/// and cranes of another simulator with cones of 1.5, 3 and 8 degrees; rocking machines 71 to 75 of our own with cones
/// of 0.6 degrees: where they were estimated, three false alarms in 30 drives; considered with 1.5, a crane's sensors
/// that turned by 0.5 and 1.5 degrees were named late or not.
inline constexpr double considered_cone_sds = 1.0, estimated_cone_sds = 1.5;
inline constexpr double considered_cone = 0.07, max_cone = 0.35;
/// [m] A point known no better than this is estimated: its products with accelerations are beyond linearisation. Points
/// that an identification on a still base saw are known to millimetres, the others to 1 m and more.
inline constexpr double unknown_point_sd = 0.2;
/// [rad] The base counts as tilted beyond this, and beyond so many standard deviations. [rad/s] At which the tilt's
/// direction changes in a segment. Blocks of rows in which what an unknown turn makes of a tilt stays as it is: with 50
/// a boom at rest on 0.5 degrees was stated to 0.18 degrees after 3 s, and was 0.73 off. Excavators 2 and 3 and arms 2
/// and 3 of another simulator, slopes of 0.5 to 5 degrees, rocking by 0.5 to 2.5 degrees.
inline constexpr double least_tilt = 3.5e-3, tilt_sds = 3.0, turn_shown = 0.03, turn_blocks = 500.0;
inline constexpr double max_position_sd = 1.8;  ///< [rad] an angle that could be any; [m] likewise
inline constexpr double max_motion_sd = 30.0;   ///< per second, per second²

/// A rest of a sensor: three blocks [s] of so many rows in which its instruments scatter by their own noise, times
/// this.
inline constexpr double rest_block = 0.25, rest_noise = 1.4;
inline constexpr int min_rest_rows = 10;
inline constexpr double upright_axis =
    0.05;                                   ///< [rad] nearer to the vertical gravity does not hold a position in a rest
inline constexpr double rest_creep = 5e-5;  ///< [rad/s] that a rest may hide
/// Correlation of a position with the noise that it has integrated. Excavator and six-axis arm 1 to 4, consumer: with
/// all of it the variance of the first seconds became negative.
inline constexpr double most_shared_noise = 0.5;
inline constexpr double steady_rate = 0.05;  ///< [rad/s] sd of a joint's velocity where it is steady and no rest

/// A base moves where its angular velocity, averaged over so long [s], is beyond this [rad/s] and so many standard
/// deviations of noise and bias.
/// Where sensors disagree, this share of it suffices.
inline constexpr double motion_suspicion = 0.4;
inline constexpr double base_mean = 0.1, base_rate = 2e-3, base_significance = 5.0;

/// Averaging of the chain's positions with the composed ones: shares below the first are none, DIODEM trial 1, first
/// half; they change over the second [s], which smooths the steps of the chain's variance at its updates.
inline constexpr double least_share = 0.1, share_time = 0.1;
/// The chain's heading, where it wanders by this [rad], has this correlation time [s]; it is watched over the last [s].
/// A heading that nothing shows at the start is known like this [rad]. DIODEM trial 1, first half.
inline constexpr double wander_sd = 0.035, wander_time = 5.0, wander_memory = 10.0, start_offset_sd = 0.05;
inline constexpr double first_heading_sd = 0.5;  ///< [rad] of a heading that motion has just begun to show

/// A spherical joint's heading is estimated after so many updates in motion. From then on its corrections are watched
/// over so long [s], beyond so many standard deviations. Simulated chains of two to five joints.
inline constexpr int heading_updates = 5;
inline constexpr double heading_watch = 1.0, heading_significance = 2.0;

inline constexpr double fault_stretch = 0.5;  ///< [s] over which the scores of constant faults are summed

inline constexpr double update_period = 0.02;   ///< [s] at most 50 updates a second
inline constexpr double longest_bridge = 0.03;  ///< [s] between two blocks without a gap
inline constexpr int period_steps = 9;          ///< between rows, whose median is the sampling period: four may be lost
inline constexpr double longest_step = 0.1;     ///< [s] of a prediction
/// An update after a longer one is linearised again at most so often, until no fast state moves further than this.
inline constexpr int relinearisations = 6;
inline constexpr double linearised = 1e-4;

}  // namespace kinfer::track
