#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/synth/creature.h"

namespace kinequad::synth_detail {
namespace {

/// Bones, by the side where there are two.
struct QuadrupedBones {
    int pelvis, spine, chest, neck, head;
    int tail_root, tail_middle, tail_tip;
    int upper_arm, forearm, hand;
    int thigh, shin, foot;
};

QuadrupedBones add_quadruped_bones(CreatureBuilder& body) {
    QuadrupedBones s{};
    s.pelvis = body.add_bone(-1, {0, 0.60, -0.34});
    s.spine = body.add_bone(s.pelvis, {0, 0.62, -0.14});
    s.chest = body.add_bone(s.spine, {0, 0.62, 0.12});
    s.neck = body.add_bone(s.chest, {0, 0.68, 0.36});
    s.head = body.add_bone(s.neck, {0, 0.82, 0.51});
    s.tail_root = body.add_bone(s.pelvis, {0, 0.65, -0.52});
    s.tail_middle = body.add_bone(s.tail_root, {0, 0.645, -0.66});
    s.tail_tip = body.add_bone(s.tail_middle, {0, 0.62, -0.80});
    s.upper_arm = body.add_bone_pair(s.chest, {0.105, 0.52, 0.27});
    s.forearm = body.add_bone_pair(s.upper_arm, {0.125, 0.36, 0.22});
    s.hand = body.add_bone_pair(s.forearm, {0.127, 0.15, 0.25});
    s.thigh = body.add_bone_pair(s.pelvis, {0.105, 0.54, -0.33});
    s.shin = body.add_bone_pair(s.thigh, {0.125, 0.36, -0.25});
    s.foot = body.add_bone_pair(s.shin, {0.12, 0.18, -0.395});
    return s;
}

void add_trunk(CreatureBuilder& body, const QuadrupedBones& s) {
    body.add_tube({{{{0, 0.60, -0.40}, 0.130, s.pelvis},
                    {{0, 0.61, -0.29}, 0.145, s.pelvis},
                    {{0, 0.615, -0.14}, 0.132, s.pelvis, s.spine},
                    {{0, 0.600, 0}, 0.138, s.spine},
                    {{0, 0.585, 0.12}, 0.155, s.spine, s.chest},
                    {{0, 0.580, 0.23}, 0.160, s.chest},
                    {{0, 0.605, 0.32}, 0.130, s.chest}},
                   stretch_along(Vector3::UnitX(), 1.12)});
    body.add_tube({{{{0, 0.63, 0.29}, 0.118, s.chest},
                    {{0, 0.69, 0.375}, 0.098, s.chest, s.neck},
                    {{0, 0.76, 0.45}, 0.086, s.neck},
                    {{0, 0.82, 0.51}, 0.086, s.neck, s.head},
                    {{0, 0.84, 0.54}, 0.086, s.head}}});
    body.add_tube({{{{0, 0.845, 0.535}, 0.097, s.head},
                    {{0, 0.838, 0.60}, 0.086, s.head},
                    {{0, 0.808, 0.68}, 0.060, s.head},
                    {{0, 0.795, 0.75}, 0.050, s.head}}});
    body.add_tube_pair({{{{0.052, 0.905, 0.52}, 0.044, s.head},
                         {{0.072, 0.955, 0.515}, 0.033, s.head},
                         {{0.084, 0.995, 0.515}, 0.018, s.head}},
                        stretch_along({0.25, 0, 1}, 1.8)});
    body.add_tube({{{{0, 0.635, -0.43}, 0.062, s.pelvis},
                    {{0, 0.65, -0.52}, 0.043, s.pelvis, s.tail_root},
                    {{0, 0.655, -0.59}, 0.038, s.tail_root},
                    {{0, 0.645, -0.66}, 0.036, s.tail_root, s.tail_middle},
                    {{0, 0.632, -0.73}, 0.036, s.tail_middle},
                    {{0, 0.62, -0.80}, 0.036, s.tail_middle, s.tail_tip},
                    {{0, 0.62, -0.87}, 0.035, s.tail_tip},
                    {{0, 0.63, -0.94}, 0.027, s.tail_tip}}});
}

void add_limbs(CreatureBuilder& body, const QuadrupedBones& s) {
    body.add_tube_pair({{{{0.088, 0.580, 0.26}, 0.085, s.chest},
                         {{0.105, 0.510, 0.268}, 0.077, s.chest, s.upper_arm},
                         {{0.118, 0.430, 0.245}, 0.063, s.upper_arm},
                         {{0.125, 0.360, 0.220}, 0.052, s.upper_arm, s.forearm},
                         {{0.127, 0.285, 0.225}, 0.046, s.forearm},
                         {{0.127, 0.205, 0.240}, 0.039, s.forearm},
                         {{0.127, 0.150, 0.250}, 0.038, s.forearm, s.hand},
                         {{0.127, 0.100, 0.254}, 0.037, s.hand}}});
    body.add_tube_pair(
        {{{{0.127, 0.055, 0.255}, 0.043, s.hand}, {{0.128, 0.048, 0.305}, 0.047, s.hand}},
         stretch_along(Vector3::UnitY(), 1.1)});
    body.add_tube_pair({{{{0.085, 0.580, -0.33}, 0.100, s.pelvis},
                         {{0.105, 0.525, -0.325}, 0.098, s.pelvis, s.thigh},
                         {{0.118, 0.445, -0.285}, 0.082, s.thigh},
                         {{0.125, 0.360, -0.250}, 0.060, s.thigh, s.shin},
                         {{0.125, 0.290, -0.300}, 0.049, s.shin},
                         {{0.122, 0.230, -0.352}, 0.040, s.shin},
                         {{0.120, 0.180, -0.392}, 0.036, s.shin, s.foot},
                         {{0.120, 0.115, -0.385}, 0.035, s.foot}}});
    body.add_tube_pair(
        {{{{0.120, 0.055, -0.365}, 0.042, s.foot}, {{0.121, 0.048, -0.315}, 0.046, s.foot}},
         stretch_along(Vector3::UnitY(), 1.1)});
    body.add_contact_pair(s.hand, {0.127, 0.008, 0.255});
    body.add_contact_pair(s.hand, {0.128, 0.005, 0.305});
    body.add_contact_pair(s.foot, {0.120, 0.008, -0.365});
    body.add_contact_pair(s.foot, {0.121, 0.005, -0.315});
}

Pose walk_at(const std::vector<Bone>& bones, const QuadrupedBones& s, double phase) {
    const double angle = 2 * std::numbers::pi * phase;
    Pose pose;
    pose.rotation.assign(bones.size(), Eigen::Quaterniond::Identity());
    const auto rotation = [&](int bone) -> Eigen::Quaterniond& { return pose.rotation[at(bone)]; };
    const double sway = std::cos(angle);
    const double lag = std::sin(angle);
    rotation(s.pelvis) = turn_y(-5 * sway) * turn_z(2.5 * lag);
    rotation(s.spine) = turn_y(6 * sway) * turn_z(-2 * lag) * turn_x(2 * std::cos(2 * angle));
    rotation(s.chest) = turn_y(5 * lag) * turn_z(-2 * sway) * turn_x(-2 * std::cos(2 * angle));
    rotation(s.neck) = turn_y(-5 * lag) * turn_x(6 + 4 * std::cos(2 * angle + 0.6));
    rotation(s.head) = turn_y(4 * sway - 4 * lag) * turn_x(-4 - 4 * std::cos(2 * angle + 0.4));
    rotation(s.tail_root) = turn_y(14 * std::sin(angle + 0.4)) * turn_x(-14);
    rotation(s.tail_middle) = turn_y(17 * std::sin(angle - 0.5)) * turn_x(8);
    rotation(s.tail_tip) = turn_y(20 * std::sin(angle - 1.4)) * turn_x(16);
    pose.shift = Vector3(0.012 * lag, 0, 0);

    const auto pose_side = [&](double stride, auto bone, auto side) {
        // A walk in lateral sequence: the fore foot comes down a quarter of a stride after the hind
        // foot of its side. Keys are tenths of a stride from where a foot comes down, degrees.
        const double fore = stride - 0.25;
        rotation(bone(s.thigh)) =
            side(turn_x(-cyclic_curve({20, 14, 7, 0, -8, -16, -22, -10, 10, 21}, stride)));
        rotation(bone(s.shin)) =
            side(turn_x(cyclic_curve({-2, 4, 6, 5, 2, -2, 8, 28, 26, 7}, stride)));
        rotation(bone(s.foot)) =
            side(turn_x(-cyclic_curve({-2, 4, 8, 6, 2, -8, -4, 28, 34, 11}, stride)));
        rotation(bone(s.upper_arm)) =
            side(turn_x(-cyclic_curve({21, 14, 7, 0, -7, -14, -20, -8, 10, 22}, fore)));
        rotation(bone(s.forearm)) =
            side(turn_x(-cyclic_curve({0, 3, 3, 1, -2, -4, 12, 48, 40, 10}, fore)));
        rotation(bone(s.hand)) =
            side(turn_x(cyclic_curve({-8, -10, -8, -2, 4, 12, 34, 62, 30, 0}, fore)));
    };
    pose_side(
        phase, [](int bone) { return bone; }, [](const Eigen::Quaterniond& q) { return q; });
    pose_side(
        phase + 0.5, [&](int bone) { return bones[at(bone)].mirror; },
        [](const Eigen::Quaterniond& q) { return mirrored(q); });
    return pose;
}

}  // namespace

Creature make_quadruped() {
    CreatureBuilder body;
    const QuadrupedBones s = add_quadruped_bones(body);
    add_trunk(body, s);
    add_limbs(body, s);
    Creature& creature = body.creature;
    creature.pair_landmarks = {{0.128, 0.03, 0.36}, {0.121, 0.03, -0.26}, {0.125, 0.36, 0.15},
                               {0.12, 0.19, -0.45}, {0.13, 0.36, -0.18},  {0.09, 1.03, 0.515},
                               {0.15, 0.58, 0.3}};
    creature.stationary_landmarks = {
        {0, 0.79, 0.82}, {0, 0.96, 0.53}, {0, 0.63, -0.98}, {0, 0.76, 0}, {0, 0.44, 0.1}};
    creature.walk = [s, bones = creature.bones](double phase) { return walk_at(bones, s, phase); };
    return creature;
}

}  // namespace kinequad::synth_detail
