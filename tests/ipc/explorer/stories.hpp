// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "tests/ipc/explorer/story.hpp"

/// The stories that are explored completely. With HANDCAST_EXPLORE=deep, stories have one message
/// or one take more.
namespace handcast::explorer::stories {

/// A new story.
using Made = std::unique_ptr<Story>;

/// Readers that copy.
/// @{
Made copying();
Made copying_the_first_of_many();
Made copying_two_words();
Made following_in_order();
Made looking_back();
Made abandoning();
/// @}

/// Readers that take leases.
/// @{
Made leasing_with_fewer_slots_than_leases();
Made leasing();
Made leasing_with_slots_enough();
Made leasing_beside_a_copy();
Made leasing_in_order();
Made looking_back_under_leases();
Made two_leases_of_one_reader();
Made two_leases_beside_a_copy();
Made two_leases_with_few_slots();
/// @}

/// Readers that wait.
/// @{
Made waiting();
Made waiting_for_leases();
/// @}

/// The writer dies, and a successor continues.
/// @{
Made writer_dies_before_one_copy();
Made writer_dies_before_copies();
Made writer_dies_before_a_lease_and_a_copy();
Made writer_dies_before_leases();
Made writer_dies_on_a_ring_with_history();
Made writer_dies_before_sleepers();
Made two_writers_die();
/// @}

/// A reader dies, and another one takes its row.
/// @{
Made leasing_reader_dies();
Made reader_with_two_leases_dies();
Made waiting_reader_dies();
Made writer_and_reader_die();
Made two_want_the_row_of_the_dead();
Made two_recover_at_once();
Made recoverer_dies_half_way();
Made living_reader_is_taken_for_dead();
Made row_changes_hands();
/// @}

/// Counters wrap around.
/// @{
Made generations_wrap_around();
Made epochs_wrap_around();
Made futex_and_lease_sequences_wrap_around();
/// @}

}  // namespace handcast::explorer::stories
