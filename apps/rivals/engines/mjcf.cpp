// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/engines/mjcf.hpp"

#include <sstream>

#include "apps/rivals/engines/bounce.hpp"

namespace rivals {
namespace {

std::string numbers(const Vector3d& v) {
  std::ostringstream s;
  s.precision(17);
  s << v[0] << ' ' << v[1] << ' ' << v[2];
  return s.str();
}

std::string frame(const Isometry3d& X) {
  const Quaterniond q(X.linear());
  std::ostringstream s;
  s.precision(17);
  s << " pos=\"" << numbers(X.translation()) << "\" quat=\"" << q.w() << ' ' << q.x() << ' '
    << q.y() << ' ' << q.z() << "\"";
  return s.str();
}

class Writer {
 public:
  Writer(const Scene& scene, double h, const std::string& options, const std::string& sizes)
      : scene_(scene), h_(h) {
    out_.precision(17);
    out_ << "<mujoco><compiler angle=\"radian\" balanceinertia=\"false\" boundmass=\"0\" "
            "boundinertia=\"0\"/>"
         << "<option gravity=\"" << numbers(scene.gravity) << "\"" << options << "/>";
    if (!sizes.empty()) out_ << "<size " << sizes << "/>";
    out_ << "<worldbody>";
    // Bit 1 is the ground, bit 2 the bodies that touch one another.
    if (scene.ground) {
      out_ << "<geom type=\"plane\" size=\"0 0 1\" contype=\"1\" conaffinity=\"1\" priority=\"1\"";
      friction(scene.frictionOnGround());
      out_ << "/>";
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (parentOf(static_cast<int>(i)) < 0) body(static_cast<int>(i));
    out_ << "</worldbody>";
    ties();
    out_ << "</mujoco>";
  }
  std::string text() const { return out_.str(); }

 private:
  int parentOf(int i) const {
    const Joint* j = scene_.carrier(i);
    return j ? j->parent : -1;
  }

  /// A restitution is a spring and a damper that an impact leaves after thirty steps (solref in its
  /// direct form).
  void friction(double coefficient) {
    out_ << " friction=\"" << coefficient << " 0.005 0.0001\"";
    if (scene_.restitution == 0.0) return;
    const double omega = EIGEN_PI / (30.0 * h_);
    out_ << " solref=\"" << -omega * omega << ' ' << -2.0 * dampingOfBounce(scene_, omega) * omega
         << "\"";
  }

  void body(int i) {
    const Body& b = scene_.bodies[static_cast<std::size_t>(i)];
    out_ << "<body name=\"" << b.name << "\""
         << frame(scene_.startOf(parentOf(i)).inverse() * b.start.pose()) << ">";
    joint(i);
    out_ << "<inertial pos=\"0 0 0\" mass=\"" << b.mass << "\" diaginertia=\"" << numbers(b.inertia)
         << "\"/>";
    for (const Shape& s : b.shapes) {
      const char* type = s.kind == ShapeKind::box      ? "box"
                         : s.kind == ShapeKind::sphere ? "sphere"
                                                       : "capsule";
      out_ << "<geom type=\"" << type << "\" size=\"" << numbers(s.size) << "\"" << frame(s.pose)
           << " contype=\"" << (scene_.collide ? 3 : 0) << "\" conaffinity=\""
           << (scene_.collide ? 3 : 1) << "\"";
      friction(scene_.friction);
      out_ << "/>";
    }
    for (std::size_t k = 0; k < scene_.bodies.size(); ++k)
      if (parentOf(static_cast<int>(k)) == i) body(static_cast<int>(k));
    out_ << "</body>";
  }

  void joint(int i) {
    const Joint* j = scene_.carrier(i);
    if (!j) {
      out_ << "<freejoint/>";
      return;
    }
    const Isometry3d X = scene_.startOf(i);
    out_ << "<joint pos=\"" << numbers(X.inverse() * j->anchor) << "\"";
    if (j->kind == JointKind::ball) {
      out_ << " type=\"ball\"/>";
      return;
    }
    out_ << " type=\"" << (j->kind == JointKind::hinge ? "hinge" : "slide") << "\" axis=\""
         << numbers(X.linear().transpose() * j->axis) << "\"";
    if (j->range)
      out_ << " limited=\"true\" range=\"" << j->range->first << ' ' << j->range->second << "\"";
    out_ << "/>";
  }

  void ties() {
    out_ << "<equality>";
    for (const Joint& j : scene_.joints) {
      if (j.kind != JointKind::tie) continue;
      const Body& child = scene_.bodies[static_cast<std::size_t>(j.child)];
      out_ << "<connect body1=\"" << child.name << "\" anchor=\""
           << numbers(child.start.pose().inverse() * j.anchor) << "\"";
      if (j.parent >= 0)
        out_ << " body2=\"" << scene_.bodies[static_cast<std::size_t>(j.parent)].name << "\"";
      out_ << "/>";
    }
    out_ << "</equality>";
  }

  const Scene& scene_;
  double h_;
  std::ostringstream out_;
};

}  // namespace

std::string mjcf(const Scene& scene, double h, const std::string& options,
                 const std::string& sizes) {
  return Writer(scene, h, options, sizes).text();
}

}  // namespace rivals
