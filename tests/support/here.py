"""What the limited process does, done in this one: a second saved for every test file that reads a workbook."""

from flexlash.reading.refusal import Refusal

WHERE = "flexlash.reading.limited_process._answer"


def answer_here(task, limits, arguments, then):
    """Take the place of the limited process; faults of the program show themselves as they are."""
    try:
        answer = task(*arguments)
        return then(answer) if then else answer
    except Refusal as refusal:
        return refusal
    except MemoryError:
        return limits.exceeded("memory_mebibytes")
