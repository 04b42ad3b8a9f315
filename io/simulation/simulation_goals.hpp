// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The goals of a Simulation, by the names of links. Names that do not exist throw NameError, with
/// the nearest that does.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/goals.hpp"

namespace softgauss {

/// A link or joint that the model lacks. what() reads "reach: found 'hnd', expected a link of model
/// 'arm', did you mean 'hand'? there are: …".
class NameError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SimulationParts;

/// Reach, hold and posture come with virtual damping and, without a posture of their own, a weak
/// one about the start, as they do on the command line of simulate_gdd; a reach of a robot that
/// stands comes with balance too. The first goal of all makes the leapfrog the integrator, where
/// nobody has named one.
class SimulationGoals {
 public:
  explicit SimulationGoals(SimulationParts& parts) : parts_(&parts) {}

  /// A point of the link, given in the link's frame [m], seeks a place in the world [m]; without a
  /// weight [kg] 2.5 times the robot's mass, times the weight of the strongest posture beside it
  /// where that is above 1. Where that point has such a goal already, its place,
  /// and the weight if one is given, become these. The goal lives until remove() or clear().
  gdd::Reach& reach(const std::string& link, const Vector3& p_WTarget,
                    const Vector3& p_LP = Vector3::Zero(),
                    std::optional<double> weight = std::nullopt);
  /// The link stays where and as it is.
  gdd::Hold& hold(const std::string& link);
  /// All joints and floating bases seek the configuration at which the simulation started.
  gdd::Posture& posture(double weight = gdd::Posture::kDefaultWeight);
  /// Those of a YAML file, in its order; nothing comes with them. Throws ModelError.
  std::vector<gdd::Goal*> read(const std::filesystem::path& file);
  /// The same from the text of such a file; messages call it `name`.
  std::vector<gdd::Goal*> readText(const std::string& text, const std::string& name = "goals");
  /// Any other goal; nothing comes with it.
  gdd::Goal& add(std::unique_ptr<gdd::Goal> goal);
  /// To be called after a goal was changed: weights that nobody has given are again what they are
  /// beside the postures, and who sleeps wakes.
  void weighDefaults();
  /// Removes one of the goals; what came with it stays. Throws std::invalid_argument where it is
  /// none of these.
  void remove(const gdd::Goal& goal);
  void clear();

  std::size_t size() const;
  bool empty() const { return size() == 0; }
  gdd::Goal& operator[](std::size_t i);

 private:
  std::vector<gdd::Goal*> addAll(io::GoalFile asked);
  gdd::Goal& addOwn(std::unique_ptr<gdd::Goal> goal);
  void addRegularisers(std::optional<double> postureWeight);
  void addBalance();
  gdd::Posture& ownPosture(double weight);
  void expectLink(const std::string& goal, const std::string& link) const;

  SimulationParts* parts_;
};

}  // namespace softgauss
