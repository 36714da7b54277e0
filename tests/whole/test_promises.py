"""What flexlash promises to whoever hands something in, and the tests that hold each promise."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]

PROMISES = {
    "R1 a submission is done with its report, rejected with the reason, or waits; none is lost, doubled or altered": {
        "service/test_kills_and_faults.py": ["test_r1_r2_a_kill_at_each_kind_of_step_loses_doubles_and_alters_nothing"],
        "service/test_store.py": ["test_r1_what_was_committed_is_there_after_the_process_was_killed"],
    },
    "R2 a report is whole or absent, and has the same bytes again": {
        "service/test_kills_and_faults.py": ["test_r1_r2_a_kill_at_each_kind_of_step_loses_doubles_and_alters_nothing"],
        "service/test_blobs.py": ["test_r2_a_damaged_file_cannot_be_downloaded"],
        "service/test_poison.py": ["test_files_are_those_of_the_command_whoever_computes_them"],
    },
    "R3 a full disk, a failing one and missing rights lose nothing": {
        "service/test_kills_and_faults.py": ["test_r3_a_fault_of_this_machine_at_each_kind_of_step_loses_nothing"],
        "service/test_store.py": ["test_r3_a_commit_that_the_disk_refuses_is_undone_and_the_next_holds"],
    },
    "R4 what kills or hangs its reader costs three tries and 20 s each, the others are done": {
        "service/test_poison.py": ["test_r4_poison_costs_three_tries_and_the_others_are_done"],
        "reading/test_limited_process.py": ["test_a_reader_that_goes_astray_is_refused_by_name"],
    },
    "R5 nothing that is handed in gives a traceback, hangs, or takes more than a gibibyte": {
        "service/test_web_whole.py": ["test_r5_r6_files_that_must_be_refused_are_refused_by_name"],
        "service/test_web_mutants.py": ["test_no_request_is_a_fault"],
        "reading/test_mutants.py": ["test_no_mutant_takes_long_or_much"],
        "reading/test_corpus.py": ["test_every_public_workbook_ends_in_an_outcome"],
    },
    "R6 a refusal is right and named, and what need not be refused is read": {
        "service/test_web_whole.py": ["test_r5_r6_files_that_must_be_refused_are_refused_by_name"],
        "reading/test_own_workbooks.py": ["test_what_must_be_refused_is_refused_by_name"],
        "reading/test_corpus.py": ["test_every_public_workbook_is_told_by_the_right_name"],
    },
    "R7 nothing is read short or altered": {
        "reading/test_corpus.py": ["test_public_workbooks_are_read_alike_by_another_reader"],
        "reading/test_own_workbooks.py": ["test_another_reader_sees_the_same_numbers_and_texts"],
        "reading/test_mutants.py": ["test_no_flipped_bit_alters_a_cell"],
    },
    "R8 what stands in a file or its name is inert in reports, logs, terminals, pages and paths": {
        "service/test_inbox.py": ["test_r8_hostile_names_are_inert_everywhere"],
        "service/test_delivering.py": ["test_r8_a_name_in_out_never_leads_elsewhere"],
        "service/test_reasons.py": ["test_r8_what_a_submission_says_is_inert_in_the_text"],
        "service/test_web_whole.py": ["test_texts_in_cells_are_inert"],
        "cli/test_status.py": ["test_hostile_names_stay_on_their_line"],
    },
    "R9 while a file is read nothing is called and nothing else is written": {
        "reading/test_limited_process.py": ["test_no_network_and_no_stray_write", "test_a_reader_writes_nothing"],
        "reading/test_inside_limits.py": ["test_what_reaches_outside_is_forbidden"],
    },
    "R10 hundreds at once, stopped again and again, all end right, and memory stays": {
        "service/test_soak.py": [
            "test_r10_all_end_right_though_servers_and_workers_are_killed",
            "test_r10_five_hundred_end_right_and_memory_is_flat",
        ],
        "service/test_web_memory.py": ["test_large_files_leave_no_memory_behind"],
    },
    "R11 a copy that is not whole yet is never judged": {
        "service/test_inbox.py": [
            "test_r11_a_slow_copy_is_taken_once_it_is_whole",
            "test_r11_torn_copies_at_every_sector_are_not_judged_early",
        ],
    },
    "R12 two services, or two runs, on one folder do no harm": {
        "service/test_races.py": ["test_r12_two_services_race_for_the_same_files"],
        "service/test_places.py": ["test_r12_a_second_service_is_refused"],
    },
    "R13 each limit lets in its value and refuses one more": {
        "reading/test_reading_limits.py": ["test_at_the_limit_and_one_above", "test_every_limit_has_a_test"],
    },
    "R14 what was found wrong once stays found, and two thousand mutants surprise nobody": {
        "reading/test_mutants.py": ["test_every_mutant_is_read_or_refused"],
        "service/test_web_mutants.py": ["test_no_request_is_a_fault"],
    },
}


def test_there_are_fourteen():
    """The promises are numbered from R1 to R14, each with a test."""
    assert [promise.split()[0] for promise in PROMISES] == [f"R{number}" for number in range(1, 15)]
    assert all(PROMISES.values())


@pytest.mark.parametrize("promise", PROMISES)
def test_a_promise_has_its_tests(promise):
    """Each test that is to hold a promise is there, says what it claims, and does so by an assertion or a check."""
    for file, names in PROMISES[promise].items():
        tree = ast.parse((TESTS / file).read_text(encoding="utf-8"))
        found = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        for name in names:
            assert name in found, f"{file} has no {name}"
            assert ast.get_docstring(found[name])
            assert any(isinstance(node, ast.Assert | ast.Call) for node in ast.walk(found[name]))
