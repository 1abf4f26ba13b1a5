#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/synth/creature.h"

namespace kinequad::synth_detail {
namespace {

/// Bones, by the side where there are two.
struct BipedBones {
    int pelvis, spine, chest, neck, head;
    int upper_arm, forearm, hand;
    int thigh, shin, foot, toes;
};

BipedBones add_biped_bones(CreatureBuilder& body) {
    BipedBones s{};
    s.pelvis = body.add_bone(-1, {0, 0.95, 0});
    s.spine = body.add_bone(s.pelvis, {0, 1.08, -0.01});
    s.chest = body.add_bone(s.spine, {0, 1.22, -0.01});
    s.neck = body.add_bone(s.chest, {0, 1.48, -0.015});
    s.head = body.add_bone(s.neck, {0, 1.57, 0});
    s.upper_arm = body.add_bone_pair(s.chest, {0.175, 1.405, -0.012});
    s.forearm = body.add_bone_pair(s.upper_arm, {0.362, 1.212, -0.016});
    s.hand = body.add_bone_pair(s.forearm, {0.530, 1.026, 0});
    s.thigh = body.add_bone_pair(s.pelvis, {0.095, 0.90, -0.005});
    s.shin = body.add_bone_pair(s.thigh, {0.115, 0.50, 0.010});
    s.foot = body.add_bone_pair(s.shin, {0.125, 0.095, -0.020});
    s.toes = body.add_bone_pair(s.foot, {0.132, 0.035, 0.105});
    return s;
}

void add_trunk(CreatureBuilder& body, const BipedBones& s) {
    body.add_tube({{{{0, 0.945, 0}, 0.142, s.pelvis},
                    {{0, 1.02, 0.004}, 0.139, s.pelvis},
                    {{0, 1.11, 0.004}, 0.129, s.pelvis, s.spine},
                    {{0, 1.21, 0.001}, 0.136, s.spine, s.chest},
                    {{0, 1.31, -0.004}, 0.149, s.chest},
                    {{0, 1.385, -0.012}, 0.125, s.chest}},
                   stretch_along(Vector3::UnitZ(), 1.35)});
    body.add_tube({{{{0, 1.40, -0.02}, 0.066, s.chest},
                    {{0, 1.48, -0.012}, 0.055, s.chest, s.neck},
                    {{0, 1.55, 0.005}, 0.052, s.neck, s.head},
                    {{0, 1.60, 0.015}, 0.055, s.head}}});
    body.add_tube({{{{0, 1.615, 0.048}, 0.066, s.head},
                    {{0, 1.665, 0.028}, 0.094, s.head},
                    {{0, 1.705, 0.004}, 0.100, s.head}},
                   stretch_along(Vector3::UnitX(), 1.12)});
    body.add_tube({{{{0, 1.672, 0.105}, 0.014, s.head}, {{0, 1.640, 0.124}, 0.017, s.head}}});
    body.add_tube_pair(
        {{{{0.089, 1.668, -0.002}, 0.030, s.head}, {{0.087, 1.640, 0.004}, 0.022, s.head}},
         stretch_along({1, 0, -0.4}, 2.2)});
    body.add_tube_pair({{{{0.066, 0.915, -0.052}, 0.080, s.pelvis},
                         {{0.070, 0.895, -0.050}, 0.078, s.pelvis, s.thigh}}});
}

void add_limbs(CreatureBuilder& body, const BipedBones& s) {
    body.add_tube_pair({{{{0.110, 1.415, -0.010}, 0.066, s.chest},
                         {{0.175, 1.400, -0.012}, 0.066, s.chest, s.upper_arm},
                         {{0.235, 1.345, -0.013}, 0.058, s.upper_arm},
                         {{0.300, 1.275, -0.015}, 0.052, s.upper_arm},
                         {{0.334, 1.241, -0.016}, 0.046, s.upper_arm},
                         {{0.362, 1.212, -0.016}, 0.043, s.upper_arm, s.forearm},
                         {{0.390, 1.181, -0.014}, 0.045, s.forearm},
                         {{0.430, 1.137, -0.010}, 0.045, s.forearm},
                         {{0.490, 1.070, -0.004}, 0.035, s.forearm},
                         {{0.530, 1.026, 0}, 0.030, s.forearm, s.hand},
                         {{0.555, 0.998, 0.002}, 0.030, s.hand}}});
    body.add_tube_pair({{{{0.548, 1.005, 0.002}, 0.036, s.hand},
                         {{0.575, 0.975, 0.005}, 0.048, s.hand},
                         {{0.606, 0.938, 0.007}, 0.043, s.hand},
                         {{0.632, 0.906, 0.007}, 0.033, s.hand}},
                        stretch_along({0.743, 0.669, 0}, 1.9)});
    body.add_tube_pair({{{{0.562, 0.995, 0.020}, 0.021, s.hand},
                         {{0.578, 0.966, 0.052}, 0.019, s.hand},
                         {{0.588, 0.944, 0.072}, 0.015, s.hand}}});
    body.add_tube_pair({{{{0.075, 0.930, 0}, 0.100, s.pelvis},
                         {{0.095, 0.885, -0.003}, 0.096, s.pelvis, s.thigh},
                         {{0.100, 0.790, 0}, 0.087, s.thigh},
                         {{0.107, 0.680, 0.008}, 0.074, s.thigh},
                         {{0.112, 0.570, 0.010}, 0.060, s.thigh},
                         {{0.115, 0.500, 0.010}, 0.054, s.thigh, s.shin},
                         {{0.117, 0.430, 0}, 0.053, s.shin},
                         {{0.120, 0.340, -0.014}, 0.055, s.shin},
                         {{0.122, 0.240, -0.017}, 0.045, s.shin},
                         {{0.124, 0.150, -0.020}, 0.036, s.shin},
                         {{0.125, 0.095, -0.020}, 0.035, s.shin, s.foot},
                         {{0.125, 0.060, -0.020}, 0.036, s.foot}}});
    body.add_tube_pair({{{{0.125, 0.046, -0.046}, 0.040, s.foot},
                         {{0.127, 0.052, 0.020}, 0.046, s.foot},
                         {{0.132, 0.038, 0.100}, 0.042, s.foot, s.toes},
                         {{0.134, 0.030, 0.165}, 0.034, s.toes}},
                        stretch_along(Vector3::UnitY(), 1.2)});
    body.add_contact_pair(s.foot, {0.125, 0.006, -0.05});
    body.add_contact_pair(s.foot, {0.132, 0.004, 0.10});
    body.add_contact_pair(s.toes, {0.134, 0.002, 0.165});
}

/// Joint angles of a brisk human walk in degrees at tenths of a stride that starts as the heel
/// comes down: flexion of hip and knee, dorsiflexion of ankle and toes.
struct Leg {
    double hip, knee, ankle, toes;
};
Leg leg_at(double stride) {
    return {cyclic_curve({30, 26, 17, 6, -6, -15, -8, 13, 29, 33}, stride),
            cyclic_curve({7, 17, 16, 9, 7, 16, 42, 66, 46, 14}, stride),
            cyclic_curve({2, -5, 3, 7, 10, 4, -17, -6, 2, 3}, stride),
            cyclic_curve({8, 0, 0, 0, 6, 24, 12, 0, 4, 10}, stride)};
}

Pose walk_at(const std::vector<Bone>& bones, const BipedBones& s, double phase) {
    const double angle = 2 * std::numbers::pi * phase;
    Pose pose;
    pose.rotation.assign(bones.size(), Eigen::Quaterniond::Identity());
    const auto rotation = [&](int bone) -> Eigen::Quaterniond& { return pose.rotation[at(bone)]; };
    const double sway = std::cos(angle);
    const double shift = std::sin(angle);
    rotation(s.pelvis) = turn_y(-7 * sway) * turn_z(3 * shift) * turn_x(4);
    rotation(s.spine) = turn_y(8 * sway) * turn_z(-3.5 * shift) * turn_x(1);
    rotation(s.chest) =
        turn_y(8 * sway) * turn_z(-1 * shift) * turn_x(1 + 1.5 * std::cos(2 * angle));
    rotation(s.neck) = turn_y(-4 * sway) * turn_x(-2);
    rotation(s.head) = turn_y(-3 * sway + 4 * shift) * turn_x(-3 + 2 * std::cos(2 * angle + 1));
    pose.shift = Vector3(0.018 * shift, 0, 0.012 * std::cos(2 * angle));

    const Vector3 elbow_axis = Vector3(-0.743, -0.669, 0).normalized();
    const auto pose_side = [&](double stride, auto bone, auto side) {
        const Leg leg = leg_at(stride);
        rotation(bone(s.thigh)) = side(turn_x(-leg.hip) * turn_z(-1.5));
        rotation(bone(s.shin)) = side(turn_x(leg.knee));
        rotation(bone(s.foot)) = side(turn_x(-leg.ankle) * turn_y(5));
        rotation(bone(s.toes)) = side(turn_x(-leg.toes));
        const double swing = std::cos(2 * std::numbers::pi * (stride + 0.5));
        const double elbow = 38 + 24 * std::cos(2 * std::numbers::pi * (stride + 0.46));
        rotation(bone(s.upper_arm)) = side(turn_x(-26 * swing + 5) * turn_z(-27 - 3 * swing));
        rotation(bone(s.forearm)) =
            side(Eigen::Quaterniond(Eigen::AngleAxisd(elbow * std::numbers::pi / 180, elbow_axis)));
        rotation(bone(s.hand)) = side(turn_z(-6 - 8 * swing));
    };
    pose_side(
        phase, [](int bone) { return bone; }, [](const Eigen::Quaterniond& q) { return q; });
    pose_side(
        phase + 0.5, [&](int bone) { return bones[at(bone)].mirror; },
        [](const Eigen::Quaterniond& q) { return mirrored(q); });
    return pose;
}

}  // namespace

Creature make_biped() {
    CreatureBuilder body;
    const BipedBones s = add_biped_bones(body);
    add_trunk(body, s);
    add_limbs(body, s);
    Creature& creature = body.creature;
    creature.pair_landmarks = {{0.66, 0.87, 0.007}, {0.59, 0.94, 0.09},  {0.395, 1.205, -0.05},
                               {0.134, 0.02, 0.21}, {0.125, 0.03, -0.1}, {0.115, 0.50, 0.07},
                               {0.12, 1.66, 0},     {0.18, 1.48, -0.012}};
    creature.stationary_landmarks = {
        {0, 1.82, 0}, {0, 1.63, 0.15}, {0, 1.3, 0.12}, {0, 0.80, 0}, {0, 1.3, -0.12}};
    creature.walk = [s, bones = creature.bones](double phase) { return walk_at(bones, s, phase); };
    return creature;
}

}  // namespace kinequad::synth_detail
