// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/stories.hpp"

namespace handcast::explorer::stories {
namespace {

int deeper() { return explores_deep() ? 1 : 0; }

Made on(const RingShape& shape) { return std::make_unique<Story>(shape); }

Reading copies(int takes) { return {.takes = takes + deeper()}; }
Reading copies_in_order(int takes) { return {.verb = Verb::next, .takes = takes + deeper()}; }
Reading leases(int takes) { return {.hold = Hold::lease, .takes = takes + deeper()}; }
Reading leases_in_order(int takes) {
  return {.verb = Verb::next, .hold = Hold::lease, .takes = takes + deeper()};
}
Reading two_leases(int takes) {
  return {.hold = Hold::lease, .takes = takes + deeper(), .leases_at_once = 2};
}
Reading sleeps(int takes) { return {.takes = takes, .waits = true}; }

Made writer_dies(const RingShape& shape, int publishes, int then_publishes, const Reading& first,
                 const Reading& second) {
  auto story = on(shape);
  const int writer = story->writer(publishes);
  story->reader(0, first);
  story->reader(1, second);
  story->dies(writer, {story->successor(then_publishes)});
  return story;
}

Made nobody_dies(const RingShape& shape, int publishes, const Reading& first,
                 const Reading& second) {
  auto story = on(shape);
  story->writer(publishes);
  story->reader(0, first);
  story->reader(1, second);
  return story;
}

Made reader_dies(const RingShape& shape, int publishes, const Reading& dying, const Reading& next) {
  auto story = on(shape);
  story->writer(publishes);
  const int reader = story->reader(0, dying);
  story->dies(reader, {story->claiming_reader(0, next)});
  return story;
}

}  // namespace

Made copying() { return nobody_dies({.slots = 3}, 2 + deeper(), copies(2), copies(2)); }
Made copying_the_first_of_many() {
  auto story = on({.slots = 3});
  story->writer(3 + deeper());
  story->reader(0, copies(2));
  return story;
}
Made copying_two_words() {
  auto story = on({.slots = 3, .payload_words = 2});
  story->writer(2);
  story->reader(0, copies(2));
  return story;
}
Made following_in_order() {
  return nobody_dies({.slots = 3, .keep_history = true, .messages = 2}, 2, copies_in_order(2),
                     copies_in_order(1));
}
Made looking_back() {
  auto story = on({.slots = 3, .keep_history = true});
  story->writer(3);
  story->reader(0, {.verb = Verb::nearest, .takes = 2 + deeper()});
  return story;
}
Made abandoning() {
  auto story = on({.slots = 3, .messages = 2});
  story->writer(2, 1);
  story->reader(0, copies_in_order(1));
  story->reader(1, leases_in_order(1));
  return story;
}

Made leasing_with_fewer_slots_than_leases() {
  return nobody_dies({.slots = 2}, 2 + deeper(), leases(2), leases(1));
}
Made leasing() { return nobody_dies({.slots = 3}, 2, leases(2), leases(2)); }
Made leasing_with_slots_enough() { return nobody_dies({.slots = 4}, 3, leases(1), leases(1)); }
Made leasing_beside_a_copy() { return nobody_dies({.slots = 3}, 2, leases(2), copies(1)); }
Made leasing_in_order() {
  return nobody_dies({.slots = 4, .keep_history = true}, 3, leases_in_order(2), leases_in_order(1));
}
Made looking_back_under_leases() {
  auto story = on({.slots = 3, .keep_history = true, .messages = 3});
  story->writer(1);
  story->reader(0, {.verb = Verb::nearest, .hold = Hold::lease, .takes = 2 + deeper()});
  return story;
}
Made two_leases_of_one_reader() {
  auto story = on({.slots = 4});
  story->writer(4);
  story->reader(0, two_leases(4));
  return story;
}
Made two_leases_beside_a_copy() { return nobody_dies({.slots = 4}, 2, two_leases(3), copies(1)); }
Made two_leases_with_few_slots() { return nobody_dies({.slots = 3}, 2, two_leases(2), leases(1)); }

Made waiting() { return nobody_dies({.slots = 3}, 2, sleeps(3), sleeps(2)); }
Made waiting_for_leases() {
  auto story = on({.slots = 3});
  story->writer(2 + deeper());
  story->reader(0, {.hold = Hold::lease, .takes = 3, .waits = true});
  return story;
}

Made writer_dies_before_one_copy() {
  auto story = on({.slots = 2});
  const int writer = story->writer(1);
  story->reader(0, copies(2));
  story->dies(writer, {story->successor(1)});
  return story;
}
Made writer_dies_before_copies() { return writer_dies({.slots = 3}, 2, 1, copies(1), copies(1)); }
Made writer_dies_before_a_lease_and_a_copy() {
  return writer_dies({.slots = 3}, 2, 1, leases(1), copies(1));
}
Made writer_dies_before_leases() { return writer_dies({.slots = 3}, 2, 1, leases(1), leases(1)); }
Made writer_dies_on_a_ring_with_history() {
  auto story = on({.slots = 3, .keep_history = true});
  const int writer = story->writer(3);
  story->reader(0, copies_in_order(2));
  story->dies(writer, {story->successor(1)});
  return story;
}
Made writer_dies_before_sleepers() { return writer_dies({.slots = 3}, 2, 0, sleeps(2), sleeps(2)); }
Made two_writers_die() {
  auto story = on({.slots = 3});
  const int first = story->writer(1), second = story->successor(1), third = story->successor(1);
  story->reader(0, copies(1));
  story->reader(1, leases(1));
  story->dies(first, {second});
  story->dies(second, {third});
  return story;
}

Made leasing_reader_dies() {
  auto story = reader_dies({.slots = 3}, 2, leases(1), leases(1));
  story->reader(1, leases(1));
  return story;
}
Made reader_with_two_leases_dies() {
  return reader_dies({.slots = 4}, 3, two_leases(3), two_leases(2));
}
Made waiting_reader_dies() { return reader_dies({.slots = 3}, 2, sleeps(2), sleeps(1)); }
Made writer_and_reader_die() {
  auto story = on({.slots = 3});
  const int writer = story->writer(2), reader = story->reader(0, leases(1));
  story->dies(writer, {story->successor(1)});
  story->dies(reader, {story->claiming_reader(0, leases(1))});
  return story;
}
Made two_want_the_row_of_the_dead() {
  auto story = on({.slots = 3});
  story->writer(1);
  const int dying = story->reader(0, leases(1));
  const int one = story->claiming_reader(0, leases(1)),
            other = story->claiming_reader(0, leases(1));
  story->dies(dying, {one, other});
  return story;
}
Made two_recover_at_once() {
  auto story = on({.slots = 3});
  story->writer(2);
  story->dead_reader(0, {0, 1});
  story->recoverer(0);
  story->claiming_reader(0, leases(1));
  return story;
}
Made recoverer_dies_half_way() {
  auto story = on({.slots = 3});
  story->writer(1);
  story->dead_reader(0, {0, 1});
  const int clears = story->recoverer(0), claims = story->claiming_reader(0, leases(1)),
            last = story->claiming_reader(0, leases(1));
  story->dies(clears, {claims});
  story->ends(clears, {claims});
  story->dies(claims, {last});
  return story;
}
Made living_reader_is_taken_for_dead() {
  auto story = on({.slots = 3});
  story->writer(1 + deeper());
  story->doubt(story->reader(0, {.hold = Hold::doubted_lease, .takes = 2}));
  story->claiming_reader(0, leases(1));
  return story;
}
Made row_changes_hands() {
  auto story = on({.slots = 3});
  story->writer(2);
  story->reader(0, leases(1));
  story->claiming_reader(0, leases(1));
  return story;
}

Made generations_wrap_around() {
  auto story = on({.slots = 3, .generation = 0xffff});
  story->writer(1);
  story->dead_reader(0, {0, 1});
  story->recoverer(0);
  story->claiming_reader(0, leases(1));
  return story;
}
Made epochs_wrap_around() {
  return writer_dies({.slots = 3, .first_epoch = 0x7fff}, 1, 1, leases(1), copies(1));
}
Made futex_and_lease_sequences_wrap_around() {
  const auto last_of_40_bits = (std::uint64_t{1} << 40) - 1;
  auto story = on({.slots = 3, .first_sequence = last_of_40_bits - 1});
  story->writer(3);
  story->reader(0, {.hold = Hold::lease, .takes = 3, .waits = true});
  return story;
}

}  // namespace handcast::explorer::stories
