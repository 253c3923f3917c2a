# Units of work on many machines: planned, done, killed and gathered with the program itself.
foreach(test IN ITEMS
    units_give_what_the_command_gives
    every_command_can_be_planned
    what_cannot_be_planned_is_refused
    costs_of_different_machines_do_not_meet
    local_submission_does_all_and_gathers
    a_sweep_of_several_cores_goes_on_where_it_was
    disturbed_units_are_measured_again
    units_are_compressed
    gnu_parallel_goes_on_where_it_was
    slurm_scripts_are_read_by_a_shell
    the_walk_through_runs)
  add_test(NAME cluster/${test}
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/cluster_test.py $<TARGET_FILE:plumb_app> ${PROJECT_SOURCE_DIR} ${test})
  set_tests_properties(cluster/${test} PROPERTIES LABELS process SKIP_RETURN_CODE 77 TIMEOUT 600)
endforeach()
foreach(test IN ITEMS
    killed_at_any_instant_nothing_is_lost
    a_gathering_that_is_killed_leaves_whole_results
    a_full_disk_is_said_and_loses_nothing
    a_disk_without_room_for_anything_ends_the_worker
    gatherings_at_once_give_whole_results
    what_is_done_twice_counts_once
    claims_of_the_dead_expire_whatever_the_clocks_say
    another_program_is_refused
    damaged_units_are_said_and_done_again)
  add_test(NAME cluster/${test}
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/failures_test.py $<TARGET_FILE:plumb_app> ${PROJECT_SOURCE_DIR} ${test})
  set_tests_properties(cluster/${test} PROPERTIES LABELS process SKIP_RETURN_CODE 77 TIMEOUT 600)
endforeach()
add_test(NAME cluster/simulate_self_test COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/simulate.py --self-test)
set_tests_properties(cluster/simulate_self_test PROPERTIES LABELS unit)
# Slurm and ssh hosts of its own, where the packages are there and the user is root: two minutes each.
foreach(scheduler IN ITEMS slurm parallel)
  add_test(NAME cluster/units_killed_under_${scheduler} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/real_schedulers.py
    $<TARGET_FILE:plumb_app> ${scheduler} free_fall elastic_collision atwood vertical_stack)
  set_tests_properties(cluster/units_killed_under_${scheduler} PROPERTIES LABELS long SKIP_RETURN_CODE 77 TIMEOUT 600)
endforeach()
