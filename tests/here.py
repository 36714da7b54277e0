"""What the limited process does, done in this one: a tenth of a second saved for every test that reads a workbook."""

import json

from flexlash.submission.reading import child
from flexlash.submission.reading.refusal import Refusal


class AskedHere:
    """Takes the place of `isolated.Asked`."""

    def __init__(self, task, data, limits, **facts):
        """Do the task at once."""
        head, self.payload = child.answer(task, data, limits, **facts)
        self.found = json.loads(json.dumps(head))

    def answer(self):
        """Return the task's answer, or raise its refusal."""
        if "refusal" in self.found:
            code, facts = self.found["refusal"]
            raise Refusal(code, **facts)
        return self.found, self.payload


def ask_here(task, data, limits, **facts):
    """Take the place of `isolated.ask`."""
    return AskedHere(task, data, limits, **facts).answer()
