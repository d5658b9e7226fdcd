#include "trainer/common/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/output.hpp"
#include "image/metrics.hpp"
#include "image/png.hpp"
#include "trainer/common/held_out.hpp"

namespace tureen::trainer {

namespace {

constexpr int record_every = 50;
/// Number of held-out views in measurements during the run. More views add time, but little
/// information.
constexpr std::size_t measured_views = 5;
/// Time between checkpoints. Writing one takes about 1 s; an interrupted run loses at most 120 s.
constexpr double checkpoint_seconds = 120;

double clock_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// 40 tests in a long run; in a shorter run every 250 steps, but at least 4 tests.
int steps_between_tests(int steps) { return std::max({steps / 40, std::min(steps / 4, 250), 1}); }

/// Exponential mean; each new value has a weight of 1/50.
double smoothed(double mean, double value) {
  return mean > 0 ? mean + 0.02 * (value - mean) : value;
}

TrainingLog open_log(const SessionOptions& options, int step) {
  if (step > 0) return TrainingLog::resume(options.log, step);
  TrainingLog log = TrainingLog::create(options.log);
  if (options.plan) log.append_plan(options.plan());
  return log;
}

}  // namespace

std::string describe(const SessionStatus& now) {
  std::string text = fmt::format("{}{}{}{}", now.paused ? "paused, " : "", now.step,
                                 now.fits_steps ? " of about " : "/", now.steps);
  if (now.loss > 0) text += fmt::format(", loss {:.4f}", now.loss);
  if (now.test_psnr_db)
    text +=
        fmt::format(", {:.2f} dB of {}", *now.test_psnr_db, counted(now.measured_views, "view"));
  if (now.seconds_per_step > 0)
    text += fmt::format(", {:.3g} it/s, {} left", 1 / now.seconds_per_step,
                        duration_text(now.seconds_left));
  return text;
}

TrainingSession::TrainingSession(Trainable& run, SessionOptions options)
    : run_(run),
      options_(std::move(options)),
      measured_views_(some_of(options_.test_views, measured_views)),
      log_(open_log(options_, run.steps_done())),
      clock_(options_.clock ? options_.clock : clock_seconds),
      start_(clock_()),
      last_checkpoint_(options_.seconds_before),
      non_finite_(options_.non_finite_before),
      fit_(options_.seconds, options_.seconds_before) {
  recent_.begin = options_.seconds_before;
}

double TrainingSession::seconds() const { return options_.seconds_before + clock_() - start_; }

void TrainingSession::run() {
  keep_if_it_fails([this] { train_to_the_end(); });
}

void TrainingSession::keep_if_it_fails(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error&) {
    // Report this error and ignore a second one from the checkpoint.
    try {
      if (!in_step_) keep();
    } catch (const OutputError&) {
    }
    throw;
  } catch (...) {
    if (!in_step_) keep();
    throw;
  }
}

void TrainingSession::keep() {
  save_checkpoint();
  if (options_.interrupted) options_.interrupted(status());
}

void TrainingSession::train_to_the_end() {
  while (!at_the_end()) {
    if (options_.progress) options_.progress(status());
    make_snapshot();
    wait_while_paused();
    const double before = seconds(), work = run_.work_of_step();
    in_step_ = true;
    const StepReport report = run_.step();
    in_step_ = false;
    // The first step allocates.
    const double kept = ++steps_here_ > 2 ? 0.98 : 0;
    pace_ = {1 + kept * pace_.steps, work + kept * pace_.work,
             seconds() - before + kept * pace_.seconds};
    fit_.after_step(run_, work, seconds());
    finishes_ = options_.control && options_.control->command() == RunCommand::finish;
    after_step(report);
  }
}

void TrainingSession::wait_while_paused() {
  if (!options_.control) return;
  start_ += options_.control->wait_while_paused([this] {
    if (options_.progress) options_.progress(status(true));
  });
}

void TrainingSession::make_snapshot() {
  const double begin = seconds() - options_.seconds_before;
  if (!options_.snapshot || !snapshots_.due(begin)) return;
  options_.snapshot();
  snapshots_.made(begin, seconds() - options_.seconds_before);
}

void TrainingSession::after_step(const StepReport& report) {
  ++recent_.steps;
  recent_.loss += report.loss;
  recent_.l1 += report.l1;
  recent_.ssim += report.ssim;
  recent_.mse += report.mse;
  non_finite_ += report.non_finite;
  loss_ = smoothed(loss_, report.loss);

  const int step = run_.steps_done();
  // From the steps of now: fits change them.
  const bool test = step % steps_between_tests(run_.steps()) == 0 || at_the_end();
  if (test) measure();
  if (test || step % record_every == 0) record();
  if (options_.preview_every > 0 && (step % options_.preview_every == 0 || at_the_end()))
    write_preview();
  if (at_the_end()) return;
  if (options_.checkpoint_every ? step % *options_.checkpoint_every == 0
                                : seconds() - last_checkpoint_ >= checkpoint_seconds)
    save_checkpoint();
}

void TrainingSession::measure() {
  if (measured_views_.empty()) return;
  fresh_test_psnr_ = mean_psnr_db(run_, measured_views_);
  shown_test_psnr_ = fresh_test_psnr_;
}

void TrainingSession::record() {
  const double n = recent_.steps, now = seconds();
  log_.append({.step = run_.steps_done(),
               .steps = run_.steps(),
               .seconds = now,
               .seconds_left = seconds_left(),
               .loss = recent_.loss / n,
               .l1 = recent_.l1 / n,
               .ssim = recent_.ssim / n,
               .train_psnr_db = psnr_from_mse(recent_.mse / n),
               .test_psnr_db = fresh_test_psnr_,
               .primitives = run_.primitives(),
               .it_per_second = n / (now - recent_.begin),
               .non_finite = non_finite_,
               .ended_early = finishes_ && !done()});
  recent_ = {.begin = now};
  fresh_test_psnr_.reset();
}

void TrainingSession::write_preview() {
  // Eight digits for every run, so that the names sort after a change of the number of steps, too.
  Output output(options_.previews / fmt::format("step_{:08}.png", run_.steps_done()));
  output.write(encode_png(options_.test_views.empty()
                              ? run_.image({options_.preview_camera})
                              : preview(run_, options_.test_views.front())));
  output.commit();
}

void TrainingSession::save_checkpoint() {
  run_.write_checkpoint(options_.checkpoint, seconds());
  last_checkpoint_ = seconds();
}

double TrainingSession::seconds_left() const {
  if (fit_.is_pending()) return fit_.left(seconds());
  return pace_.work > 0 ? pace_.seconds / pace_.work * run_.work_left() : 0;
}

SessionStatus TrainingSession::status(bool paused) const {
  return {.step = run_.steps_done(),
          .steps = run_.steps(),
          .loss = loss_,
          .test_psnr_db = shown_test_psnr_,
          .measured_views = measured_views_.size(),
          .seconds_per_step = pace_.steps > 0 ? pace_.seconds / pace_.steps : 0,
          .seconds_left = seconds_left(),
          .fraction = fit_.seconds() > 0 ? std::min(seconds() / fit_.seconds(), 1.0)
                                         : double(run_.steps_done()) / run_.steps(),
          .fits_steps = fit_.is_pending(),
          .paused = paused};
}

}  // namespace tureen::trainer
