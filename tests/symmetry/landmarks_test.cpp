#include <gtest/gtest.h>

#include "kinequad/core/error.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/synth/synthesize_creature.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

class BadLandmarks : public testing::Test {
protected:
    static void SetUpTestSuite() { creature = synthesize_creature("biped", {2000, 2}, {}); }
    static void TearDownTestSuite() { creature.reset(); }

    BadLandmarks()
        : mesh{creature->read_rest_shape(), creature->triangles()}, good(creature->landmarks()) {}

    /// What the program answers: its error, or the warnings, empty where it takes the landmarks.
    std::string answer(const Landmarks& landmarks) const {
        std::string warnings;
        Context context;
        context.log = [&](LogLevel level, std::string_view line) {
            if (level == LogLevel::warning) warnings += line;
        };
        try {
            compute_symmetry_map(mesh, test::metric_of(mesh), landmarks, {}, context);
            return warnings;
        } catch (const InputError& error) {
            EXPECT_EQ(error.fault(), InputFault::symmetry);
            return error.what();
        }
    }

    void expect_answer(const Landmarks& landmarks, const std::string& part) const {
        const std::string text = answer(landmarks);
        EXPECT_NE(text.find(part), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    }

    static inline std::unique_ptr<SyntheticCreature> creature;
    TriangleMesh mesh;
    Landmarks good;
};

TEST_F(BadLandmarks, AreNotTheGoodOnes) { EXPECT_EQ(answer(good), ""); }

TEST_F(BadLandmarks, MayHaveLeftAndRightExchangedInAPair) {
    Landmarks landmarks = good;
    std::swap(landmarks.pairs[1][0], landmarks.pairs[1][1]);
    expect_answer(landmarks, "pairs[1]");
    expect_answer(landmarks, "in the opposite order");
    // Who does not mind the order is not told.
    std::swap(landmarks.pairs[2][0], landmarks.pairs[2][1]);
    std::swap(landmarks.pairs[3][0], landmarks.pairs[3][1]);
    EXPECT_EQ(answer(landmarks), "");
}

TEST_F(BadLandmarks, AreNamedWhereAPairIsGivenTwice) {
    Landmarks landmarks = good;
    landmarks.pairs.push_back({landmarks.pairs[0][1], landmarks.pairs[0][0]});
    expect_answer(landmarks, "vertex " + std::to_string(landmarks.pairs[0][1]) + " is named twice");
}

TEST_F(BadLandmarks, AreNamedWhereAPairIsOnOnePoint) {
    Landmarks landmarks = good;
    landmarks.pairs[2][1] = landmarks.pairs[2][0];
    expect_answer(landmarks, "pairs[2] joins vertex");
}

TEST_F(BadLandmarks, AreNamedWhereAVertexDoesNotExist) {
    Landmarks landmarks = good;
    landmarks.stationary.push_back(static_cast<int>(mesh.V.rows()));
    expect_answer(landmarks, "counted from 0");
}

TEST_F(BadLandmarks, AreNamedWherePartnersOfTwoPairsAreExchanged) {
    for (std::size_t i = 0; i + 1 < good.pairs.size(); ++i) {
        // On one hand an exchange is as small as a careless pick.
        const double apart =
            (mesh.V.row(good.pairs[i][0]) - mesh.V.row(good.pairs[i + 1][0])).norm();
        if (apart < 0.2) continue;
        Landmarks landmarks = good;
        landmarks.pairs[i][1] = good.pairs[(i + 1) % good.pairs.size()][0];
        landmarks.pairs[(i + 1) % good.pairs.size()][0] = good.pairs[i][1];
        const std::string text = answer(landmarks);
        const bool is_named =
            text.find("pairs[" + std::to_string(i) + "]") != std::string::npos ||
            text.find("pairs[" + std::to_string(i + 1) + "]") != std::string::npos;
        EXPECT_TRUE(is_named) << i << ": " << text;
    }
}

TEST_F(BadLandmarks, AreNamedWhereAStationaryVertexIsOnOneSide) {
    Landmarks landmarks = good;
    landmarks.stationary.push_back(landmarks.pairs[0][0]);
    landmarks.pairs.erase(landmarks.pairs.begin());
    expect_answer(landmarks, "stationary[" + std::to_string(landmarks.stationary.size() - 1) +
                                 "] (" + std::to_string(landmarks.stationary.back()) +
                                 ") disagrees");
}

TEST_F(BadLandmarks, AreCountedWhereTheyAreTooFew) {
    expect_answer({}, "0 pairs and 0 stationary");
    expect_answer({{good.pairs[0]}, {}}, "1 pair and 0 stationary");
    expect_answer({{}, {good.stationary[0], good.stationary[1]}}, "at least two pairs");
}

TEST_F(BadLandmarks, AreNamedWhereAVertexIsInNoTriangle) {
    mesh.V.conservativeResize(mesh.V.rows() + 1, 3);
    mesh.V.bottomRows(1).setZero();
    Landmarks landmarks = good;
    landmarks.stationary.push_back(static_cast<int>(mesh.V.rows()) - 1);
    expect_answer(landmarks, "belongs to no triangle");
}

TEST_F(BadLandmarks, DoNotGiveAMapOfLooseParts) {
    const TriangleMesh one = test::sphere(2);
    mesh.V.resize(2 * one.V.rows(), 3);
    mesh.V << one.V, one.V.array() + 3;
    mesh.F.resize(2 * one.F.rows(), 3);
    mesh.F << one.F, one.F.array() + static_cast<int>(one.V.rows());
    expect_answer({{{3, 17}, {23, 27}}, {0}}, "2 components");
}

}  // namespace
}  // namespace kinequad
