// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/ball_headings.hpp"

#include <algorithm>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

BallHeadings::BallHeadings(const FilterModel& model) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical && !model.is_loose(b))
      balls_.push_back({.body = b, .first = model.layout.joint_state(model.layout.position[b])});
  if (!balls_.empty()) world_R_body_.resize(model.bodies.size());
}

const BallHeadings::Ball& BallHeadings::find(std::size_t body) const {
  const auto found = std::ranges::find(balls_, body, &Ball::body);
  KINFER_EXPECT(found != balls_.end());
  return *found;
}

BallHeadings::Ball& BallHeadings::find(std::size_t body) {
  return const_cast<Ball&>(std::as_const(*this).find(body));
}

void BallHeadings::consider(std::size_t body) {
  Ball& ball = find(body);
  ball.is_considered = true;
  ball.is_watched = false;
  ball.shown = 0;
}

void BallHeadings::free(std::size_t body, double sd, MatrixXd& p) {
  consider(body);
  widen(find(body), square(sd), p);
}

void BallHeadings::reset() {
  for (Ball& ball : balls_) ball.is_considered = ball.is_watched = false;
}

bool BallHeadings::is_considered(std::size_t body) const {
  return find(body).is_considered;
}

void BallHeadings::show(std::size_t body) {
  Ball& ball = find(body);
  if (ball.is_considered && ++ball.shown >= heading_updates)
    ball.is_considered = false, ball.is_watched = true, ball.since = -1.0;
}

double BallHeadings::variance(const Ball& ball, const MatrixXd& p) {
  double variance = 0.0;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j)
      variance += ball.up[i] * ball.up[j] *
                  p(ball.first + position_states * std::max(i, j), ball.first + position_states * std::min(i, j));
  return variance;
}

double BallHeadings::variance(std::size_t body, const MatrixXd& p) const {
  return variance(find(body), p);
}

void BallHeadings::widen(const Ball& ball, double variance, MatrixXd& p) {
  for (Index j = 0; j < 3; ++j)
    for (Index i = j; i < 3; ++i)
      p(ball.first + position_states * i, ball.first + position_states * j) += variance * ball.up[i] * ball.up[j];
}

void BallHeadings::begin_update(const FilterModel& model, const ChainState& state, const MatrixXd& p) {
  if (balls_.empty()) return;
  world_R_body_[0] = state.world_R_base;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const InsBody& body = model.bodies[b];
    Mat3 turn = state.spherical[b];
    if (body.motion == JointMotion::revolute) turn = rot_z(state.joints[position_states * model.layout.position[b]]);
    world_R_body_[b] = world_R_body_[static_cast<std::size_t>(body.parent)] *
                       parent_side(model, state, b).parent_R_axis * turn * body.child_R_axis.transpose();
  }
  for (Ball& ball : balls_) {
    ball.up = (world_R_body_[ball.body] * model.bodies[ball.body].child_R_axis).row(2);
    ball.before = variance(ball, p);
  }
}

void BallHeadings::limit_correction(VectorXd& error) const {
  for (const Ball& ball : balls_) {
    if (!ball.is_considered) continue;
    double heading = 0.0;
    for (Index i = 0; i < 3; ++i) heading += ball.up[i] * error[ball.first + position_states * i];
    for (Index i = 0; i < 3; ++i) error[ball.first + position_states * i] -= heading * ball.up[i];
  }
}

void BallHeadings::end_update(const Eigen::Ref<const MatrixXd>& gain, const VectorXd& error, double time, MatrixXd& p) {
  for (Ball& ball : balls_) {
    if (ball.is_considered) {
      double fall = 0.0;
      for (Index k = 0; k < gain.cols(); ++k) {
        double own = 0.0;
        for (Index i = 0; i < 3; ++i) own += ball.up[i] * gain(ball.first + position_states * i, k);
        fall += square(own);
      }
      widen(ball, fall, p);
      continue;
    }
    if (!ball.is_watched) continue;
    double correction = 0.0;
    for (Index i = 0; i < 3; ++i) correction += ball.up[i] * error[ball.first + position_states * i];
    watch(ball, correction, time, p);
  }
}

void BallHeadings::watch(Ball& ball, double correction, double time, MatrixXd& p) {
  if (ball.since < 0.0 || time < ball.since) ball.since = time, ball.sum = ball.expected = 0.0;
  ball.sum += correction;
  ball.expected += std::max(0.0, ball.before - variance(ball, p));
  if (time - ball.since < heading_watch) return;
  const double of_linearisation = square(0.5 * square(ball.sum)),
               of_lasting_errors = std::max(0.0, square(ball.sum) - square(heading_significance) * ball.expected);
  widen(ball, of_linearisation + of_lasting_errors, p);
  ball.since = time;
  ball.sum = ball.expected = 0.0;
}

}  // namespace kinfer::track
