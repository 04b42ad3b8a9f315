// SPDX-License-Identifier: Apache-2.0

/// A robot falls for a second: what the smallest program with an installed softgauss looks like.

#include <cstdio>
#include <softgauss/engine.hpp>
#include <softgauss/io.hpp>
#include <softgauss/simulation.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const softgauss::Model model = softgauss::io::loadUrdf(argv[1]);
  softgauss::State state(model);
  softgauss::Data data(model);
  while (state.time < 1.0) {
    const auto status = softgauss::step(model, softgauss::Input{}, state, data, nullptr);
    if (status == softgauss::SolveStatus::notFinite) return 3;
  }
  std::printf("after %g s the fastest joint moves at %g\n", state.time,
              state.v.lpNorm<Eigen::Infinity>());
  softgauss::Simulation sim = softgauss::Simulation::load(argv[1]);
  sim.run(0.1);
  return sim.time() > 0.0 ? 0 : 4;
}
