# The rings: shared memory, and one writer's messages to many readers.
handcast_library(handcast_ring
  SOURCES shm/segment.cpp ring/real_atomics.cpp ring/rhythm.cpp ring/ring_reader.cpp ring/ring_writer.cpp ring/row_owner.cpp
    ring/ring_view.cpp ring/seat.cpp ring/wait.cpp ring/wake_bridge.cpp
  LINKS handcast_base)
if(HANDCAST_SANITIZE MATCHES thread)
  # g++ 12: ThreadSanitizer does not model fences. The tests keep the payload atomic, so it misses nothing that matters here.
  target_compile_options(handcast_ring PUBLIC -Wno-tsan)
endif()
