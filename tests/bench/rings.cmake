handcast_program(bench_rings SOURCES ${CMAKE_CURRENT_LIST_DIR}/rings.cpp LINKS handcast_ring benchmark::benchmark)
