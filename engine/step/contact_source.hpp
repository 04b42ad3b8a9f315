// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where contacts come from: the engine's only virtual call, once per step.

#include <cstdint>
#include <vector>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/dynamics/tree_selection.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

class ContactSource {
 public:
  virtual ~ContactSource() = default;

  /// Whether any two shapes may ever touch; where not, a step does not ask for contacts.
  bool mayTouch() const { return mayTouch_; }

  /// Fills `contacts` (cleared first) with every point whose distance < margin of its pair, in an
  /// order that depends on the model and the poses alone. Throws nothing; a query that cannot be
  /// answered is counted in contacts.pairsSkipped.
  virtual void detect(const Model& model, const Kinematics& kinematics,
                      ContactSet& contacts) noexcept = 0;

  /// Those of these trees, with each other, with the world and with trees that are still
  /// (TreeSelection::setStill()).
  virtual void detectAmong(const Model& model, const Kinematics& kinematics,
                           const TreeSelection& trees, ContactSet& contacts) noexcept {
    detect(model, kinematics, contacts);
    std::erase_if(contacts.contacts,
                  [&](const Contact& c) { return !trees.meets(model, c.bodyA, c.bodyB); });
  }

  /// The contacts of these two geometries alone, A and B as in detect(), after a detect() near
  /// these poses.
  virtual void detectPair(const Model& model, const Kinematics& kinematics, int geometryA,
                          int geometryB, ContactSet& contacts) noexcept {
    detect(model, kinematics, contacts);
    std::erase_if(contacts.contacts, [&](const Contact& c) {
      return c.geometryA != geometryA || c.geometryB != geometryB;
    });
  }

  /// Which way a motion is followed from a state.
  enum class TimeDirection : std::uint8_t { forward, backward };

  /// A time [s], at most `longest`, in which no two shapes pass through each other unseen, going on
  /// or back with the velocities of `kinematics`, by someone who looks at least twice in it, evenly
  /// (7.7). Depends on the poses and the velocities alone.
  virtual double tunnellingTimeBound(const Model&, const Kinematics&, double longest,
                                     TimeDirection) noexcept {
    return longest;
  }

  /// How often detect() has found where all shapes are: detectAmong() may take those of trees that
  /// are still from the last time.
  std::int64_t fullDetections() const { return fullDetections_; }

  /// Memory that it holds for the shapes and pairs of the scene.
  virtual std::size_t bytes() const noexcept { return 0; }

 protected:
  bool mayTouch_ = true;
  std::int64_t fullDetections_ = 0;
};

/// The same contacts at every step, for tests and for callers with a collision engine of their own.
class FixedContacts final : public ContactSource {
 public:
  std::vector<Contact> points;
  void detect(const Model&, const Kinematics&, ContactSet& contacts) noexcept override {
    contacts.clear();
    for (const Contact& contact : points) contacts.add(contact);
  }
};

}  // namespace softgauss
