// SPDX-License-Identifier: Apache-2.0
// When a tracker calls something a fault, with the data that the numbers were set on.
#pragma once

#include <cstddef>

#include "kinfer/base/threshold.hpp"

namespace kinfer::track {

inline constexpr double lost_after = 0.2;      ///< [s] without samples
inline constexpr double stuck_after = 0.15;    ///< [s] with the same sample, and at least
inline constexpr int stuck_rows = 20;          ///< rows of it: noise exceeds the resolution of any such sensor
inline constexpr double clipped_memory = 0.5;  ///< [s]

inline constexpr double short_mean = 0.5, long_mean = 10.0;  ///< [s] of the leave-one-out innovations
KINFER_THRESHOLD(track, max_single, 400.0);                  // of one block
KINFER_THRESHOLD(track, quick_limit, 2.5);                   // of the short mean
KINFER_THRESHOLD(track, slow_limit, 1.6);                    // of the long mean
/// [s] over which what a machine shows all the time is gathered, and how long it is remembered.
inline constexpr double peak_length = 2.0, peak_memory = 60.0;
/// A joint has changed, too, where its short mean is beyond the first and so many times what it has shown in the last
/// minute. Drives of sound simulated machines reach 1.76 times that (quick ones), iiwa 1.56, DIODEM 1.21, UR5 none; 3
/// mm of play in the first joint, consumer, 2.5 to 3.6 times, with a mean of 1.6 to 2.2.
KINFER_THRESHOLD(track, least_joint_change, 1.4);
KINFER_THRESHOLD(track, joint_stands_out, 2.2);
inline constexpr double lasting_strength = 0.7;  ///< as long as it is not below that it is the same change
inline constexpr double recovered_limit = 1.2;
/// A sensor that is named as moved may be turned by so much [rad] about each axis, as standard deviation. It is turned
/// where its samples are likelier by so much (ln) than with the mounting that it had, and returns where these are.
inline constexpr double turned_mount_sd = 0.05, mount_log_odds = 3.0;
/// [rad] No mounting is more certain, also where scale matrices are not estimated: one that is exactly known has no
/// odds.
inline constexpr double least_turn_sd = 1e-5;
/// [s] over which the scores of turns are summed, after which a change that they show is examined, and how long they
/// are remembered. It is examined where twice the log-likelihood of a turn is beyond this, and beyond this times what
/// any sensor has shown, and is one where it is so much likelier (ln) than no change. Of sound simulated excavators,
/// consumer, twice the log-likelihood reaches 10; of turns by 0.5° it is 26 to 78 and 4.5 to 12 times what was shown;
/// of DIODEM on its slack mounts 38 and 1.6 times, of iiwa and UR5 13 and 2.2 times.
inline constexpr double turn_mean = 0.3, turn_patience = 1.0;
KINFER_THRESHOLD(track, turn_evidence, 16.0);
KINFER_THRESHOLD(track, turn_stands_out, 3.0);
KINFER_THRESHOLD(track, sudden_log_odds, 12.0);
/// Steps of the time at which a sensor turned; a joint's change must still be seen in the last of the rows.
inline constexpr std::size_t turn_step = 5, lasting_blocks = 25;
inline constexpr double clock_mean = 5.0;       ///< [s] over which a clock is watched
inline constexpr double least_lateness = 2e-3;  ///< [s] below which no clock is called late
/// Twice the log-likelihood that a sensor's lateness must gain, and its share of the sensor's disagreement; more where
/// the sensor was named for something else already. Simulated excavators and six-axis arms 31 and 32, with turned
/// sensors, play and samples 20 ms late.
KINFER_THRESHOLD(track, lateness_evidence, 60.0);
KINFER_THRESHOLD(track, lateness_share, 0.5);
inline constexpr double lateness_share_later = 0.75;
/// Median over the sensors of the factors on their variances, beyond which the chain as a whole does not fit, and below
/// which it fits again. Of another machine's log it exceeds the first within a second; real healthy chains on soft
/// mounts reach 80, a UR5 with wrong accelerometers 215 for a moment.
KINFER_THRESHOLD(track, misfit_inflation, 100.0);
inline constexpr double fitting_inflation = 10.0;
inline constexpr double settling = 3.0;            ///< [s] after a start
inline constexpr std::size_t replay_blocks = 100;  ///< two seconds: at least so much is replayed, at most twice
/// [s] without rows, or without any sensor, after which the posture is found anew. Excavators and six-axis arms in
/// quick drives are followed over 0.5 s, and no longer over 0.6 s.
inline constexpr double restart_gap = 0.5;
/// [rad] A joint that is less certain than this when its sensor comes back is sought again.
inline constexpr double turned_in_gap = 0.08;
/// Two sensors are said to be exchanged beyond these ln odds, where no factor on a sensor's variances is then larger;
/// updates by which it is judged, and how often after something did not fit, since a machine may stand still. Of
/// simulated excavators, arms and cranes with exchanged sensors all pairs: at most 1.2; where a sensor turned by 1.5
/// rad 5.7.
KINFER_THRESHOLD(track, exchange_log_odds, 12.0);
KINFER_THRESHOLD(track, exchange_inflation, 3.0);
inline constexpr std::size_t exchange_blocks = 100;
inline constexpr int most_exchange_trials = 5;
/// A sensor that comes back beside a joint that is less certain than `turned_in_gap`: the position is sought over so
/// many seconds of rows, and as often again while no place on the circle is so much likelier than the others (ln), for
/// the longest time [s]; from so many places, those within so many standard deviations, each settled in so many rounds.
inline constexpr double return_length = 0.25, return_patience = 1.0, return_log_odds = 10.0, return_reach = 3.0;
inline constexpr int return_places = 12, return_rounds = 4;
/// [s] without one instrument of a sensor while the other one measures, after which it is called lost; and after which
/// orientations from that sensor alone are not used.
inline constexpr double instrument_lost_after = 1.0, instrument_missing_after = 0.2;
/// Squared distance of an instrument's biases from the handed-over ones in their prior variances. Sound simulated
/// machines (excavator, crane, six-axis arm, tree; still and rocking; 40 drives of 120 s) reach 5, iiwa 2, DIODEM 13,
/// UR5 26; an accelerometer that is 0.5 m/s² off 95 to 880.
KINFER_THRESHOLD(track, bias_limit, 50.0);
inline constexpr double bias_recovered = 12.0;

/// A sensor was turned before the first row where that is so much likelier (ln) than what is usual of its mounting, of
/// this standard deviation [rad] at least, and than any other constant fault; by so many stretches of the log at least.
inline constexpr double least_usual_turn = 2e-3;
KINFER_THRESHOLD(track, initial_turn_log_odds, 12.0);
/// [rad] that gravity turns through in a sensor's frame, beyond which a turn of the sensor is told from a bias.
inline constexpr double bias_is_told = 0.03;
inline constexpr double most_initial_turn = 0.15;  ///< [rad] beyond which one linearisation does not hold
inline constexpr std::size_t least_fault_stretches = 5;
inline constexpr double undecided_turn_patience = 20.0;  ///< [s] that nothing is named while it is open which sensor
/// The other constant faults that compete: a delay of all gyroscopes [s], a scale of all accelerometers [1]; what is
/// usual, and standard deviation of a fault.
inline constexpr double usual_delay = 1e-3, delay_sd = 1e-2, usual_scale = 1e-3, scale_sd = 1e-2;
inline constexpr double fault_correlation = 2.0;    ///< [s] that what the chain does not explain may last
inline constexpr double initial_turn_after = 10.0;  ///< [s] of rows, unless something does not fit

}  // namespace kinfer::track
