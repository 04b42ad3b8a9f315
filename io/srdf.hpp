// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads what an SRDF says about the robot of a URDF: states by name (group_state), and links that
/// never collide (disable_collisions, and disable_default_collisions but for enable_collisions).
/// Groups, end effectors, virtual joints are not read.
///
/// A value of several numbers, as a virtual joint of a base has, is left out: a base stands on the
/// ground, or where it is said to be. Angles [rad], SI units.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::io {

struct Srdf {
  using LinkPairs = std::vector<std::pair<std::string, std::string>>;
  struct State {
    std::string name, group;
    std::vector<std::pair<std::string, double>> joints;  ///< and where they are [rad or m]
  };
  std::filesystem::path file;  ///< empty: there is none
  std::vector<State> states;   ///< in the order of the file
  LinkPairs apart;             ///< never collide
  std::vector<std::string>
      apartFromOthers;  ///< links that collide with none of the robot's others,
  LinkPairs together;   ///< but for these

  /// Each name once, in the order of the file.
  std::vector<std::string> stateNames() const;
  /// The joints of all states of that name, or of GROUP/NAME the one of that group; of two values
  /// of one joint the last. Throws ModelError where there is no such state.
  std::vector<std::pair<std::string, double>> positions(const std::string& name) const;
  /// Pairs of these links that never collide, each once.
  LinkPairs apartAmong(const std::vector<std::string>& links) const;
};

/// Throws ModelError.
Srdf readSrdf(const std::filesystem::path& file);

/// SRDFs of the package of a URDF, any of which may be meant: in its folder or the one above, of
/// each also in `srdf` and `config`. The one called as the URDF, alone, or else all for a robot of
/// this name.
std::vector<std::filesystem::path> findSrdfs(const std::filesystem::path& urdf,
                                             const std::string& robot);

/// What is asked of the SRDF of a robot.
struct SrdfChoice {
  std::filesystem::path file;  ///< empty: the one of the package; `none`: none
  std::string state;           ///< in which the robot starts; empty: none is asked for
  bool search = true;          ///< without a state too
  std::string named;           ///< how one is named, `--srdf FILE`
};

/// The SRDF that is meant. One that nobody asked for and that cannot be read is a warning, several
/// are too. Throws ModelError where one was asked for, or a state that it lacks; `where` and
/// `element` are what asked for the state.
Srdf chooseSrdf(const std::filesystem::path& urdf, const std::string& robot,
                const SrdfChoice& choice, const SourceLocation& where, const std::string& element,
                std::vector<std::string>& warnings);

/// Places the joints of a state; of a robot in a scene, those called prefix + joint. Joints that
/// the model lacks are left out, a value beyond a joint's range is brought to its end, and what
/// follows a joint is where that has it. Returns what is to be reported.
std::vector<std::string> placeState(const Model& model, const Srdf& srdf, const std::string& state,
                                    const std::string& prefix, VectorX& q);

/// One line on an SRDF that nobody has named: its states, which `by` asks for, and how many pairs
/// of the links never collide.
std::string describe(const Srdf& srdf, const std::vector<std::string>& links,
                     const std::string& by);

/// The SRDF of a robot of a scene, or of a URDF alone.
struct RobotSrdf {
  Srdf srdf;
  std::string state;   ///< in which the robot starts; empty: in none
  std::string prefix;  ///< of the names of its links and joints in the model
};

}  // namespace softgauss::io
