// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/body.hpp"

#include <fmt/format.h>

#include <set>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/mjcf/replicate.hpp"

namespace softgauss::io::mjcf {
namespace {

class BodyReader {
 public:
  BodyReader(const Compiler& compiler, const Defaults& defaults)
      : compiler_(compiler), defaults_(defaults) {}

  std::vector<Body> read(const std::vector<const Element*>& worldbodies) {
    bodies_.emplace_back().name = "world";
    if (!worldbodies.empty()) bodies_.front().element = *worldbodies.front();
    for (const Element* world : worldbodies) {
      world->expectAttributes({});
      readParts(*world, 0, {}, defaults_.top());
    }
    nameThem();
    return std::move(bodies_);
  }

 private:
  /// What is in a body or a frame: to the body, in the frame.
  void readParts(const Element& element, int body, const Transform& X_BF,
                 const DefaultClass& childclass) {
    for (const Element& e : element.children) {
      if (e.tag == "body") {
        readBody(e, body, X_BF, childclass);
      } else if (e.tag == "frame") {
        readFrame(e, body, X_BF, childclass);
      } else if (e.tag == "replicate") {
        for (const Element& frame : replicated(e, compiler_, replicated_))
          readFrame(frame, body, X_BF, childclass);
      } else if (e.tag == "geom") {
        Placed<Geom> geom{defaults_.of(e, childclass).geom, X_BF};
        geom.item.read(e);
        at(body).geoms.push_back(std::move(geom));
      } else if (e.tag == "site") {
        readSite(e, body, X_BF, childclass);
      } else if (e.tag == "joint" || e.tag == "freejoint") {
        readJoint(e, body, X_BF, childclass);
      } else if (e.tag == "inertial") {
        if (body == 0) e.fail("is of the world, which has no inertia; expected it in a body");
        if (at(body).inertial) e.fail("is the second of its body, expected one");
        at(body).inertial = e;
      } else if (e.tag != "camera" && e.tag != "light") {
        element.expectChildren({"body", "frame", "replicate", "inertial", "joint", "freejoint",
                                "geom", "site", "camera", "light"});
      }
    }
  }

  void readBody(const Element& e, int parent, const Transform& X_PF, const DefaultClass& around) {
    e.expectAttributes({"name", "childclass", "pos", "quat", "axisangle", "xyaxes", "zaxis",
                        "euler", "mocap", "gravcomp", "sleep", "simple", "user"});
    Body body;
    body.element = e;
    body.name = e.text("name");
    body.parent = parent;
    e.read("gravcomp", body.link.gravityCompensation);
    PoseAttributes pose;
    pose.read(e);
    body.pos = pose.pos;
    body.X_PB = X_PF * pose.pose(e, compiler_);
    const int index = static_cast<int>(bodies_.size());
    bodies_.push_back(std::move(body));
    readParts(e, index, {}, defaults_.of(e, around, "childclass"));
  }

  void readFrame(const Element& e, int body, const Transform& X_BF, const DefaultClass& around) {
    e.expectAttributes(
        {"name", "childclass", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"});
    for (const Element& child : e.children)
      if (child.tag == "inertial") child.fail("is in a <frame>, expected it in the body itself");
    PoseAttributes pose;
    pose.read(e);
    readParts(e, body, X_BF * pose.pose(e, compiler_), defaults_.of(e, around, "childclass"));
  }

  void readSite(const Element& e, int body, const Transform& X_BF, const DefaultClass& around) {
    e.expectAttributes({"name", "class", "type", "group", "pos", "quat", "axisangle", "xyaxes",
                        "zaxis", "euler", "material", "size", "fromto", "rgba", "user"});
    PoseAttributes pose = defaults_.of(e, around).site;
    pose.read(e);
    Transform X = pose.pose(e, compiler_);
    if (std::array<double, 6> ends; e.readAll("fromto", ends)) {
      const Vector3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
      if (!((from - to).norm() > 1e-14)) e.fail("the points of fromto coincide, expected two");
      X = {rotationOfZ((from - to).normalized()), 0.5 * (from + to)};
    }
    at(body).sites.push_back({e, e.text("name"), X_BF * X});
  }

  void readJoint(const Element& e, int body, const Transform& X_BF, const DefaultClass& around) {
    if (body == 0) e.fail("is of the world, which has no joint; expected it in a body");
    Joint joint;
    if (e.tag == "freejoint") {
      joint.readFree(e);
    } else {
      joint = defaults_.of(e, around).joint;
      joint.read(e);
    }
    joint.compile(compiler_, X_BF);
    Body& owner = at(body);
    if (joint.type == Joint::Type::free && owner.parent != 0)
      e.fail("is free in a body that hangs from another; expected it in a child of <worldbody>");
    if (!owner.joints.empty() &&
        (joint.type == Joint::Type::free || owner.joints.front().type == Joint::Type::free))
      e.fail("is beside a free joint of the same body, expected one alone");
    if (owner.joints.size() == 6) e.fail("is the seventh of its body, expected six at most");
    owner.joints.push_back(std::move(joint));
  }

  /// Given names are each used once; what has none gets one.
  void nameThem() {
    Names bodyNames, jointNames, geomNames;
    for (Body& body : bodies_) {
      bodyNames.give(body.element, body.name, "body");
      for (const Joint& joint : body.joints) jointNames.give(joint.element, joint.name, "joint");
      for (const auto& geom : body.geoms) geomNames.give(geom.item.element, geom.item.name, "geom");
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      if (body.name.empty()) body.name = bodyNames.make(fmt::format("body{}", i));
      for (std::size_t k = 0; k < body.joints.size(); ++k) {
        Joint& joint = body.joints[k];
        if (!joint.name.empty()) continue;
        const bool isFree = joint.type == Joint::Type::free;
        joint.name = jointNames.make(isFree ? body.name
                                     : body.joints.size() == 1
                                         ? body.name + "_joint"
                                         : fmt::format("{}_joint{}", body.name, k + 1));
      }
      for (std::size_t k = 0; k < body.geoms.size(); ++k)
        if (body.geoms[k].item.name.empty())
          body.geoms[k].item.name = geomNames.make(fmt::format("{}/{}", body.name, k));
    }
  }

  class Names {
   public:
    void give(const Element& element, const std::string& name, const char* noun) {
      if (!name.empty() && !used_.insert(name).second)
        element.fail(fmt::format("has the name of another {}, expected one of its own", noun));
    }
    std::string make(std::string name) {
      while (!used_.insert(name).second) name += '_';
      return name;
    }

   private:
    std::set<std::string> used_;
  };

  Body& at(int i) { return bodies_[static_cast<std::size_t>(i)]; }

  const Compiler& compiler_;
  const Defaults& defaults_;
  std::vector<Body> bodies_;
  std::size_t replicated_ = 0;  ///< elements in copies
};

}  // namespace

std::vector<Body> readBodies(const std::vector<const Element*>& worldbodies,
                             const Compiler& compiler, const Defaults& defaults) {
  return BodyReader(compiler, defaults).read(worldbodies);
}

}  // namespace softgauss::io::mjcf
