// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/queries/query_request.h"

#include <algorithm>

#include "bodies/nearest_names.h"
#include "hgrid_proximity/bodies/name.h"
#include "node/queries/request_checks.h"
#include "node/text/frame_names.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

/// Returns the number of bodies that a query asks about.
/// @throws Refusal unknown_id if a pattern of include can match no body, or if exclude leaves no body. Otherwise a
/// query with a misspelled name would answer CLEAR.
std::size_t asked(const QueryScope& scope, const Snapshot& snapshot) {
  const BodyList& bodies = snapshot.structure().bodies;
  const std::vector<SourceGap>& gaps = snapshot.gaps();
  for (const std::string& pattern : scope.include) {
    const bool known =
        std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) { return matches(pattern, body.name); });
    const bool awaited = std::any_of(gaps.begin(), gaps.end(),
                                     [&](const SourceGap& gap) { return canMatchTogether(pattern, gap.bodies); });
    if (!known && !awaited) {
      throw Refusal(Code::unknown_id, "no body matches the glob '" + printable(pattern) + "' of include" +
                                          (isGlob(pattern) ? "" : similarNames(pattern, bodies)));
    }
  }
  std::size_t count = 0;
  for (std::uint32_t body = 0; body < bodies.size(); ++body) count += inScope(snapshot, scope, body) ? 1 : 0;
  const bool awaits =
      std::any_of(gaps.begin(), gaps.end(), [&](const SourceGap& gap) { return inScope(snapshot, scope, gap); });
  if (count == 0 && !awaits) throw Refusal(Code::unknown_id, "exclude leaves out all bodies; at least one must remain");
  return count;
}

Pose worldFromFrame(const Tick& tick, const std::string& frame, const Params& params,
                    const TransformLookup& transforms) {
  if (frame.empty() || frame == tick.world_frame) return Pose::Identity();
  // The frame may be published at another rate than the robot. So its newest pose is accepted up to ~stale_after.
  return transforms.atOrNewest(tick.world_frame, frame, tick.snapshot->stamp(), params.stale_after,
                               "the query's frame '" + printable(frame) + "'");
}

}  // namespace

PreparedQuery prepare(const QueryOptions& options, const Tick& tick, const Params& params,
                      const TransformLookup& transforms, const NarrowPhase& narrow_phase) {
  const Snapshot& snapshot = *tick.snapshot;
  const std::string frame = withoutSlash(options.frame);
  PreparedQuery prepared{snapshot, frame, worldFromFrame(tick, frame, params, transforms), {}, {}};
  checkPatterns(options.include);
  checkPatterns(options.exclude);
  QueryScope& scope = prepared.scope;
  scope.include = options.include;
  scope.exclude = options.exclude;
  if (!scope.include.empty() || !scope.exclude.empty()) prepared.of = asked(scope, snapshot);
  const auto most = static_cast<std::uint32_t>(params.max_hits);
  scope.limit = options.limit == 0 ? most : std::min(options.limit, most);
  if (options.exact) scope.exact = &narrow_phase;
  scope.deadline = options.deadline;
  if (!options.respect_allowed) return prepared;
  if (options.as_body.empty()) {
    throw Refusal(Code::bad_id,
                  "respect_allowed is true but as_body is empty; set as_body to the body whose allowed pairs are to be "
                  "left out");
  }
  scope.respect_allowed = indexOf(snapshot, options.as_body);
  return prepared;
}

QueryBox PreparedQuery::boxOf(const geometry_msgs::Pose& frame_from_box, const geometry_msgs::Vector3& size) const {
  return {world_from_frame * fromPose(frame_from_box, "the query's box"), {size.x, size.y, size.z}};
}

QueryShape PreparedQuery::shapeOf(const ::hgrid_proximity::Shape& shape, const Params& params) const {
  const Pose frame_from_shape = fromPose(shape.pose, "the query's shape");
  return {fromShape(shape, params.shapeLimits(), static_cast<std::size_t>(params.max_mesh_triangles)),
          world_from_frame * frame_from_shape, shape.padding};
}

std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name) {
  const std::uint32_t body = snapshot.structure().find(name);
  if (body == Structure::kNone) throw Refusal(Code::unknown_id, noSuchBody(name, snapshot.structure().bodies));
  return body;
}

}  // namespace hgrid
