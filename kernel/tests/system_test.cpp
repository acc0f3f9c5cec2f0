// SPDX-License-Identifier: Apache-2.0
// Goal: a system table is what its description says. Method: a two-component table, read back row by row.
#include "mamori/kernel/system.hpp"

#include "mamori/verification/verifies.hpp"

namespace mamori {
struct Sample {
    double value{0.0};
    std::int32_t count{0};
};
}  // namespace mamori
MAMORI_FIELDS(mamori::Sample, value, count)

namespace mamori {
namespace {

class Producer final : public Component {
  public:
    constexpr Producer() noexcept : Component("producer") {}
    OutPort<Sample> out{"out"};
    using Ports = mamori::Ports<&Producer::out>;
};
class Consumer final : public Component {
  public:
    constexpr Consumer() noexcept : Component("consumer") {}
    InPort<Sample> in{"in"};
    using Ports = mamori::Ports<&Consumer::in>;
};

Producer g_producer;
Consumer g_consumer;
constexpr auto kSystem =
    system(frame(1_ms), window("w", 0_us, 100_us, budget(50_us), run(g_producer, g_consumer)),
           connect(g_producer.out, g_consumer.in));
MAMORI_CHECK(kSystem);

TEST(SystemTest, TableHoldsWhatTheDescriptionSays) {
    verification::verifies("SWR-KRN-017");

    ASSERT_EQ(kSystem.windows.size(), 1U);
    EXPECT_EQ(kSystem.windows[0].budget, 50_us);
    EXPECT_EQ(kSystem.components[1], &g_consumer);
    EXPECT_EQ(kSystem.connections[0].sink, &g_consumer.in);
    EXPECT_TRUE(kSystem.connections[0].is_forward_in_window);
}

}  // namespace
}  // namespace mamori
