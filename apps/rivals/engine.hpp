// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an engine of the study does: builds the scene by its own interface, steps, and tells poses
/// and velocities. One file in engines/ an engine, one process a run (run.cpp).

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/rivals/scene.hpp"

namespace rivals {

/// The scene holds what the engine has no words for; what() says what.
class CannotExpress : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `key=value` of the command line, of which an engine takes those that it knows.
class Settings {
 public:
  /// Throws std::invalid_argument where an argument has no '='.
  explicit Settings(const std::vector<std::string>& arguments);

  std::string word(const std::string& key, const std::string& otherwise);
  double number(const std::string& key, double otherwise);
  bool flag(const std::string& key);  ///< key=1
  /// Throws std::invalid_argument with the keys that the engine has asked for.
  void expectAllTaken() const;

 private:
  std::map<std::string, std::string> given_;
  std::set<std::string> known_;
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// False where the engine itself gives up.
  virtual bool step(int count) = 0;
  virtual std::vector<BodyState> state() = 0;

  // As the engine has them: the gate compares them with the scene.
  virtual double mass() = 0;
  /// Kinetic energy now [J]; none where the engine has no word for it.
  virtual std::optional<double> kineticEnergy() { return {}; }
  /// Joint-space inertia at the start, of scenes that are a chain fixed to the world.
  virtual Eigen::MatrixXd massMatrix() { return {}; }
};

/// Name and version, as the library that runs says it.
std::string engineVersion();
/// Throws CannotExpress, and what the engine throws.
std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings);

}  // namespace rivals
