// SPDX-License-Identifier: Apache-2.0
/// @file
/// A running system in which one component writes `kCount` outputs and a component of a later window reads
/// them. The difference between two counts is the instruction count of the connections alone.
#ifndef MAMORI_VERIFICATION_BENCH_CONNECTION_RIG_HPP
#define MAMORI_VERIFICATION_BENCH_CONNECTION_RIG_HPP

#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "minimal_host.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {

/// Unique port names "0" .. "99".
template <std::size_t kIndex>
inline constexpr std::array<char, 3U> kPortName{'0' + kIndex / 10U, '0' + kIndex % 10U, '\0'};

/// Writes the same message to each output.
template <typename T, std::size_t kCount>
class ManyOutputs final : public Component {
  public:
    ManyOutputs() noexcept : ManyOutputs(std::make_index_sequence<kCount>{}) {}

    T value{};
    std::array<OutPort<T>, kCount> outputs;

    Status on_execute(ContextHandle) noexcept override {
        for (OutPort<T>& output : outputs) {
            output.write(value);
        }
        return Status::kOk;
    }

  private:
    template <std::size_t... kIndices>
    explicit ManyOutputs(std::index_sequence<kIndices...>) noexcept
        : Component("writer"), outputs{{OutPort<T>{*this, kPortName<kIndices>.data()}...}} {}
};

/// Adds the first words of all inputs.
template <typename T, std::size_t kCount>
class ManyInputs final : public Component {
  public:
    ManyInputs() noexcept : ManyInputs(std::make_index_sequence<kCount>{}) {}

    std::uint64_t sum{0U};
    std::array<InPort<T>, kCount> inputs;

    Status on_execute(ContextHandle) noexcept override {
        for (const InPort<T>& input : inputs) {
            sum += input.read()[0];
        }
        return Status::kOk;
    }

  private:
    template <std::size_t... kIndices>
    explicit ManyInputs(std::index_sequence<kIndices...>) noexcept
        : Component("reader"), inputs{{InPort<T>{*this, kPortName<kIndices>.data()}...}} {}
};

/// Executive over the two components, started.
template <std::size_t kCount, std::size_t kSize>
class ConnectionRig {
  public:
    ConnectionRig() : table_(make_table(writer_, reader_)), executive_(table_) {
        if (executive_.initialize() != Status::kOk || executive_.start() != Status::kOk) {
            throw std::runtime_error("the executive did not start");
        }
    }

    /// One major frame: write, publish, latch, read.
    void run_frame() noexcept {
        static_cast<void>(executive_.run_window(0U, host_));
        static_cast<void>(executive_.run_window(1U, host_));
    }

    /// The message that the component writes from now on.
    Message<kSize>& get_value() noexcept { return writer_.value; }
    /// Sum of the first words of all messages read so far.
    std::uint64_t get_sum() const noexcept { return reader_.sum; }

  private:
    using Writer = ManyOutputs<Message<kSize>, kCount>;
    using Reader = ManyInputs<Message<kSize>, kCount>;
    using Table = SystemTable<2U, 2U, 2U * kCount, kCount>;
    static constexpr Duration kHalf = Duration{1'800'000'000'000};

    /// Arrays of ports have no member pointers, so the rows are completed here.
    static Table make_table(Writer& writer, Reader& reader) noexcept {
        const auto windows =
            system(frame(kHalf * 2), window("write", Duration{0}, kHalf, budget(kHalf), run(writer)),
                   window("read", kHalf, kHalf, budget(kHalf), run(reader)));
        Table table{};
        table.frame = windows.frame;
        table.windows = windows.windows;
        table.components = windows.components;
        table.component_rows = windows.component_rows;
        for (std::size_t w = 0U; w < 2U; ++w) {
            table.windows[w].first_port = table.component_rows[w].first_port = w * kCount;
            table.windows[w].port_count = table.component_rows[w].port_count = kCount;
            table.windows[w].has_outputs = w == 0U;
        }
        for (std::size_t i = 0U; i < kCount; ++i) {
            table.ports[i] = detail::make_port_row(writer, writer.outputs[i]);
            table.ports[kCount + i] = detail::make_port_row(reader, reader.inputs[i]);
            table.ports[i].hash_published = nullptr;
            table.connections[i] = connect(writer.outputs[i], reader.inputs[i], any_age()).row;
        }
        for (std::size_t p = 0U; p < 2U * kCount; ++p) {
            table.ports[p].window = table.ports[p].component = p / kCount;
        }
        detail::resolve_connections(table);
        detail::resolve_modes(table);
        detail::sort_connections(table);
        return table;
    }

    Writer writer_;
    Reader reader_;
    const Table table_;
    ExecutiveFor<Table> executive_;
    MinimalHost<CountingClock> host_;
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_CONNECTION_RIG_HPP
