// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/contact_log.hpp"

#include "softgauss/io/detail/row_file.hpp"

namespace softgauss::io {

ContactLog::ContactLog(const std::filesystem::path& file, const Model& model,
                       const std::optional<TableEnd>& after)
    : model_(model),
      rows_(std::make_unique<detail::RowFile>(
          file, "contacts",
          std::vector<std::string>{"time_s", "link_a", "link_b", "shape_a", "shape_b", "x_m", "y_m",
                                   "z_m", "nx", "ny", "nz", "fx_N", "fy_N", "fz_N", "normal_N",
                                   "friction_N"},
          after ? std::optional(after->bytes) : std::nullopt)) {}

ContactLog::~ContactLog() = default;

void ContactLog::close() { rows_->close(); }
TableEnd ContactLog::end() { return {rows_->end(), 0}; }

void ContactLog::write(double time, const std::vector<Snapshot::ContactForce>& contacts) {
  for (const Snapshot::ContactForce& c : contacts) {
    const Geometry& a = model_.geometries[static_cast<std::size_t>(c.geometryA)];
    const Geometry& b = model_.geometries[static_cast<std::size_t>(c.geometryB)];
    rows_->add(time);
    for (const std::string* name : {&a.link, &b.link, &a.name, &b.name}) rows_->add(*name);
    rows_->add(c.p_WC);
    rows_->add(c.n_W);
    rows_->add(c.force);
    rows_->add(c.normalForce());
    rows_->add((c.force - c.normalForce() * c.n_W).norm());
    rows_->endRow();
  }
}

}  // namespace softgauss::io
