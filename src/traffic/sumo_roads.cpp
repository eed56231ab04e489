/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_roads.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace
{

// Junction of a lane inside one (SUMO's name ":junction_link_lane"); "" for a lane of an edge.
std::string junction_of(const std::string &lane)
{
    if (lane.empty() || lane[0] != ':')
        return "";
    const size_t edge_end = lane.rfind('_');
    const size_t end = lane.rfind('_', edge_end - 1);
    return lane.substr(1, end - 1);
}

using Points = std::vector<libsumo::TraCIPosition>;

double side_of(const libsumo::TraCIPosition &a, const libsumo::TraCIPosition &b,
               const libsumo::TraCIPosition &point)
{
    return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
}

bool lines_cross(const Points &one, const Points &other)
{
    for (size_t k = 1; k < one.size(); k++)
        for (size_t i = 1; i < other.size(); i++) {
            const auto &a = one[k - 1], &b = one[k], &c = other[i - 1], &d = other[i];
            if (side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0)
                return true;
        }
    return false;
}

bool contains(const std::vector<std::string> &list, const std::string &word)
{
    return std::find(list.begin(), list.end(), word) != list.end();
}

bool pass_over(const std::string &one, const std::string &other)
{
    using libsumo::Lane;
    if (junction_of(one).empty() || junction_of(one) != junction_of(other))
        return false;
    const auto foes_of_one = Lane::getInternalFoes(one),
               foes_of_other = Lane::getInternalFoes(other);
    if (foes_of_one.empty() && foes_of_other.empty())
        return false; // no rules here, as at an unregulated junction
    return !contains(foes_of_one, other) && !contains(foes_of_other, one) &&
           lines_cross(Lane::getShape(one).value, Lane::getShape(other).value);
}

// What the network says of all lanes, by number.
struct Lanes {
    std::vector<std::string> edges, junctions;
    std::vector<cp_road_lane> road;
    std::vector<cp_road_connection> connections;
    std::vector<std::vector<cp_lane_point>> points;
    std::vector<std::vector<cp_lane_link>> links;
    std::vector<cp_lane> lane;

    explicit Lanes(size_t count)
        : edges(count), junctions(count), road(count, {"", nullptr, 0.0, 0.0, 0.0, 0.0, 0.0}),
          points(count), links(count), lane(count, cp_lane{})
    {
    }
};

// Corners with their places along the lane: SUMO's length may be another than that of the line.
std::vector<cp_lane_point> corners_of(const Points &shape, double length_m)
{
    std::vector<cp_lane_point> corners;
    double at_m = 0.0;
    for (size_t k = 0; k < shape.size(); k++) {
        if (k > 0)
            at_m += std::hypot(shape[k].x - shape[k - 1].x, shape[k].y - shape[k - 1].y);
        const double z_m = shape[k].z > -1e8 ? shape[k].z : 0.0; // a flat network has none
        corners.push_back({shape[k].x, shape[k].y, z_m, at_m});
    }
    for (cp_lane_point &corner : corners)
        corner.at_m *= at_m > 0.0 ? length_m / at_m : 1.0;
    return corners;
}

// By the signs: SUMO's letters for a minor road, equal roads, a stop sign and an all-way stop.
// Lights have other letters, and change.
bool gives_way(const libsumo::TraCIConnection &link)
{
    return !link.state.empty() && std::strchr("m=sw", link.state[0]) != nullptr;
}

void read_links(const cp_sumo_numbers *numbers, const std::string &id, uint32_t number, Lanes *all)
{
    for (const libsumo::TraCIConnection &link : libsumo::Lane::getLinks(id)) {
        const uint32_t to = numbers->lane(link.approachedLane.c_str());
        const uint32_t via = link.approachedInternal.empty()
                                 ? CP_LANE_NONE
                                 : numbers->lane(link.approachedInternal.c_str());
        all->links[number].push_back({to, via, gives_way(link)});
        if (all->junctions[number].empty())
            all->connections.push_back({number, to, via});
    }
}

void read_lane(const cp_sumo_numbers *numbers, const std::string &id, Lanes *all)
{
    using libsumo::Lane;
    const uint32_t number = numbers->lane(id.c_str());
    const auto shape = Lane::getShape(id).value;
    const double length_m = Lane::getLength(id);
    all->edges[number] = Lane::getEdgeID(id);
    all->junctions[number] = junction_of(id);
    const bool is_inside = !all->junctions[number].empty();
    all->road[number] = {all->edges[number].c_str(),
                         is_inside ? all->junctions[number].c_str() : nullptr,
                         length_m,
                         shape.front().x,
                         shape.front().y,
                         shape.back().x,
                         shape.back().y};
    all->points[number] = corners_of(shape, length_m);
    read_links(numbers, id, number, all);
    all->lane[number] = {all->points[number].data(),
                         all->points[number].size(),
                         all->links[number].data(),
                         all->links[number].size(),
                         nullptr,
                         0,
                         Lane::getWidth(id),
                         numbers->edge(all->edges[number].c_str()),
                         0,
                         is_inside,
                         Lane::getMaxSpeed(id)};
}

} // namespace

cp_status cp_sumo_roads_read(const cp_sumo_numbers *numbers, cp_road_network **roads,
                             cp_lane_map **lanes, cp_error *error)
{
    const std::vector<std::string> ids = libsumo::Lane::getIDList();
    for (const std::string &id : ids)
        numbers->lane(id.c_str());
    Lanes all(numbers->lane_count());
    for (const std::string &id : ids)
        read_lane(numbers, id, &all);
    cp_lane_map *map = nullptr;
    cp_status status = cp_lane_map_create(all.lane.data(), all.lane.size(), &map, error);
    if (status == CP_OK)
        status = cp_road_network_create(all.road.data(), all.road.size(), all.connections.data(),
                                        all.connections.size(), roads, error);
    if (status == CP_OK)
        *lanes = map;
    else
        cp_lane_map_destroy(map);
    return status;
}

bool cp_sumo_lanes_pass_over(const char *one, const char *other)
{
    return pass_over(one, other);
}
