// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Tells in plain text what was loaded, which effects are simulated and which element of the scene
/// called each, and what is off and why.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/actuators.hpp"
#include "softgauss/io/urdf.hpp"
#include "softgauss/io/wrenches.hpp"

namespace softgauss::io {

/// An effect, in the names of --effects, whether it is simulated, and why.
struct EffectNote {
  std::string name;
  bool on = false;
  std::string reason;  ///< e.g. "21 joints, first 'hip_x'"
  bool asked = false;  ///< the scene asks for it: with `on` false, physics is left out
};

/// Every effect that interfaces name, in their order, for this model and its Options::effects.
/// `wrenches` act on it from outside.
std::vector<EffectNote> effectNotes(const Model& model,
                                    const std::vector<TimedWrench>& wrenches = {});

/// Names of those that are on.
std::vector<std::string> effectsOn(const std::vector<EffectNote>& notes);

/// A pair of links or shapes that is never tested for contact.
struct FilteredPair {
  std::string first;
  std::string second;
  std::string reason;       ///< what pairs are grouped by, e.g. "joined by a joint"
  std::string detail = {};  ///< of this pair, e.g. "by 3 mm"
};

/// How far the shapes of two links are apart.
struct LinkDistance {
  std::string first, second;
  double distance = 0.0;  ///< [m]; 0 where they overlap
};

/// What an effect took in a trial.
struct EffectCost {
  int rows = 0;           ///< most in a step
  std::size_t bytes = 0;  ///< memory that it holds
  double us = 0.0;        ///< of a step: with it less without it [µs], may be negative
};

/// What explain() is told besides the model.
struct ExplainContext {
  std::optional<UrdfContents> contents;    ///< of the file, before links were merged
  std::vector<FilteredPair> filtered;      ///< grouped by reason in the text
  std::vector<LinkDistance> clearances;    ///< of pairs of links at the start, nearest first
  std::optional<int> testedPairs;          ///< pairs of shapes that may touch
  std::vector<std::pair<int, int>> pairs;  ///< those pairs, as indices into Model::geometries
  std::vector<std::pair<std::string, Material>> materials;  ///< the surfaces that have a name
  std::vector<TimedWrench> wrenches;                        ///< that act from outside
  std::map<std::string, EffectCost> costs;                  ///< by name of an effect; may be empty
  std::int64_t unreachablePairs = 0;     ///< pairs of shapes that no configuration brings together
  std::vector<SceneActuator> actuators;  ///< that drive joints through gears and couplings
};

/// The part of explain() on contacts: for each pair of surfaces among `context.pairs`, what sinks
/// least and what sinks most into the other by its own weight, on one contact, and how fast that
/// creeps; and the softness in both forms, physical and as an impedance.
std::string softnessText(const Model& model, const ExplainContext& context);

std::string explain(const Model& model, const ExplainContext& context = {});

}  // namespace softgauss::io
